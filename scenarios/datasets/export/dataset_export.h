// Exports a scenario as a dataset: decides what goes in, prepares the folder, makes it, describes it.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/datasets/export/export_run.h"
#include "scenarios/datasets/export/sinks/truth_files.h"
#include "scenarios/datasets/systems/target_system.h"

namespace vsslam {

/// What was asked for.
struct ExportRequest {
  std::string scenario;  ///< a name from the library, or a path
  std::vector<Override> overrides{};
  std::optional<uint64_t> seed{};
  std::string system{};   ///< of target_systems(); empty: none in particular
  std::string formats{};  ///< with commas between; empty: the system's, or bag
  std::string with{};     ///< extras with commas between
  std::filesystem::path out{};
  enum class IfExists { fail, resume, overwrite } if_exists = IfExists::fail;
  int threads = 1;
};

/// What will be made.
struct ExportPlan {
  DatasetFacts facts;
  const TargetSystem* system = nullptr;
  std::vector<DatasetFormat> formats;
  std::vector<TruthKind> truth;
  std::vector<std::string> notes;  ///< decisions that a person should know of
  bool has(DatasetFormat format) const;
};
/// Throws InputError.
ExportPlan plan_export(const ExportRequest& request);

struct ExportedDataset {
  ExportOutcome outcome;
  bool was_complete = false;  ///< nothing was to be done
};
/// Throws Interrupted, ResourceError, InputError. What is finished then stays for a later resume.
ExportedDataset export_dataset(const ExportPlan& plan, const ExportRequest& request,
                               const std::atomic<bool>& stop, Progress& progress);

}  // namespace vsslam
