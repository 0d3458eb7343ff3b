#include "scenarios/run/pending_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include "core/errors.h"

namespace vsslam {

namespace fs = std::filesystem;

namespace {

fs::path beside(const fs::path& place, const char* what) {
  return place.parent_path() / fmt::format(".{}.{}{}", place.filename().string(), what, ::getpid());
}

void check(const std::error_code& error, const fs::path& path, const char* what) {
  if (error) throw ResourceError(fmt::format("{}: cannot {}: {}", path.string(), what, error.message()));
}

}  // namespace

PendingFolder::PendingFolder(fs::path place) : place_(std::move(place)), part_(beside(place_, "part")) {
  std::error_code error;
  fs::remove_all(part_, error);
  fs::create_directories(part_, error);
  check(error, part_, "make the folder");
}

PendingFolder::~PendingFolder() {
  if (done_) return;
  std::error_code ignored;
  fs::remove_all(part_, ignored);
}

void PendingFolder::commit() {
  std::error_code error;
  const fs::path old = beside(place_, "old");
  const bool replaces = fs::exists(place_, error);
  if (replaces) {
    fs::rename(place_, old, error);
    check(error, place_, "move the old result away");
  }
  fs::rename(part_, place_, error);
  check(error, place_, "rename the result into its place");
  done_ = true;
  if (replaces) fs::remove_all(old, error);
}

void link_latest(const fs::path& out, const fs::path& target) {
  std::error_code error;
  const fs::path fresh = beside(out / "latest", "link");
  fs::remove(fresh, error);
  fs::create_directory_symlink(fs::relative(target, out), fresh, error);
  check(error, fresh, "make the link");
  fs::rename(fresh, out / "latest", error);
  check(error, out / "latest", "make the link");
}

}  // namespace vsslam
