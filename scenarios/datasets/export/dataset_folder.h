// The folder of a dataset: empty, begun or complete, and what may be done about it.
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/datasets/export/dataset_export.h"

namespace vsslam {

/// Makes a folder ready for an export whose settings are `key`. While the export lasts, a file in it says so.
class DatasetFolder {
 public:
  /// Throws InputError: the folder has something else in it, or another export, or a finished one, and the request does
  /// not say what to do about that.
  DatasetFolder(std::filesystem::path folder, std::string key, ExportRequest::IfExists if_exists);

  /// It holds this very dataset already.
  bool complete() const { return complete_; }
  /// The dataset is whole.
  void mark_complete() const;

 private:
  void begin() const;

  std::filesystem::path folder_;
  std::string key_;
  bool complete_ = false;
};

}  // namespace vsslam
