#include "core/files.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

TEST(Files, AppearsOnlyWhenCommitted) {
  const fs::path dir = scratch_folder() / "files_test";
  fs::remove_all(dir);
  {
    AtomicFile file(dir / "a" / "x.txt");
    file.write("hello");
    EXPECT_FALSE(fs::exists(dir / "a" / "x.txt"));
  }
  EXPECT_TRUE(fs::is_empty(dir / "a"));
  write_file(dir / "a" / "x.txt", "hello");
  EXPECT_EQ(read_file(dir / "a" / "x.txt"), "hello");
  fs::remove_all(dir);
}

TEST(Files, FullDiskIsAResourceError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  const fs::path dir = scratch_folder() / "files_full";
  fs::create_directories(dir);
  EXPECT_THROW(write_file("/proc/nowhere/x", "1"), ResourceError);
  fs::remove_all(dir);
}

TEST(Files, MissingFolderAndLimitAreInputErrors) {
  EXPECT_THROW(read_file("/nonexistent/file"), InputError);
  EXPECT_THROW(read_file("/tmp"), InputError);
  EXPECT_THROW(read_file("/dev/zero", 1000), InputError);
}

}  // namespace
}  // namespace vsslam
