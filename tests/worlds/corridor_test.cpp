#include "worlds/corridor.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "worlds/room.h"
#include "worlds/route.h"

namespace vsslam {
namespace {

TEST(Corridor, DefaultRing) {
  const World world = make_corridor({});
  EXPECT_GT(world.triangle_count(), 10'000u);
  EXPECT_LT(world.triangle_count(), 120'000u);
  ASSERT_FALSE(world.routes.empty());
  EXPECT_EQ(world.routes.front().name, "ring");
  EXPECT_NEAR(route_length_m(world.routes.front()), 2 * (75 + 18) - 8 * 1.2 + 2 * M_PI * 1.2, 0.05);
}

}  // namespace
}  // namespace vsslam
