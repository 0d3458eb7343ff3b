#include "scenarios/datasets/formats/recording_chunks.h"

#include <algorithm>

namespace vsslam {

void ChunkedRecording::count(RecordedChunk chunk, const ChunkContent& content, RecordingIndex& index) {
  if (content.messages.empty()) return;
  const auto [first, last] =
      std::minmax_element(content.messages.begin(), content.messages.end(),
                          [](const auto& a, const auto& b) { return a.recorded < b.recorded; });
  chunk.begin = first->recorded;
  chunk.end = last->recorded;
  index.chunks.push_back(std::move(chunk));
  for (const ChunkContent::Message& message : content.messages) ++index.messages[message.connection];
}

}  // namespace vsslam
