#include "core/suggestion.h"

#include <gtest/gtest.h>

namespace vsslam {
namespace {

TEST(Suggestion, NamesTheNearestWordOrElseEveryWord) {
  const std::vector<std::string> formats = {"bag", "mcap", "kitti"};
  EXPECT_EQ(suggestion("kiti", formats), "did you mean kitti?");
  EXPECT_EQ(suggestion("parquet", formats), "one of: bag, mcap, kitti");
}

}  // namespace
}  // namespace vsslam
