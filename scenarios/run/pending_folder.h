// A result folder appears whole or not at all: it is filled beside its place and renamed.
#pragma once

#include <filesystem>

namespace vsslam {

/// Removes what was written unless commit() was called.
class PendingFolder {
 public:
  /// `place` is the final folder; its parents are made. Throws ResourceError.
  explicit PendingFolder(std::filesystem::path place);
  ~PendingFolder();
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  /// Where to write until commit().
  const std::filesystem::path& path() const { return part_; }
  /// Puts the folder in its place; an older one there is replaced.
  void commit();

 private:
  std::filesystem::path place_, part_;
  bool done_ = false;
};

/// Points the symbolic link `out`/latest at `target`, a folder inside `out`.
void link_latest(const std::filesystem::path& out, const std::filesystem::path& target);

}  // namespace vsslam
