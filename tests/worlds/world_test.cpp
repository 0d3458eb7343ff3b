#include "worlds/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/errors.h"
#include "core/files.h"
#include "tests/scratch.h"
#include "worlds/describe.h"
#include "worlds/factory/world_source.h"
#include "worlds/gltf/gltf.h"
#include "worlds/kit/likeness.h"
#include "worlds/route.h"

namespace vsslam {
namespace {

namespace fs = std::filesystem;

TEST(Floor, WavesHaveTheStatedRms) {
  const Floor floor{.height_m = 0.5, .unevenness_m = 0.004, .wavelength_m = 2.0, .seed = 3};
  double sum = 0, sum2 = 0;
  constexpr int kSide = 300;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double z = floor.height(i * 0.37, j * 0.41) - 0.5;
      sum += z, sum2 += z * z;
    }
  EXPECT_NEAR(std::sqrt(sum2 / (kSide * kSide)), 0.004, 0.0004);
  EXPECT_NEAR(sum / (kSide * kSide), 0, 0.0002);
}

TEST(Floor, NormalIsTheGradientOfTheHeight) {
  const Floor floor{.unevenness_m = 0.02, .wavelength_m = 1.3, .seed = 9};
  constexpr double h = 1e-5;
  for (int i = 0; i < 50; ++i) {
    const double x = 0.7 * i, y = 3 - 0.4 * i;
    const Vec3 numeric(-(floor.height(x + h, y) - floor.height(x - h, y)) / (2 * h),
                       -(floor.height(x, y + h) - floor.height(x, y - h)) / (2 * h), 1);
    EXPECT_LT((floor.normal(x, y) - numeric.normalized()).norm(), 1e-8);
  }
  EXPECT_EQ(Floor{}.normal(3, 4), Vec3::UnitZ());
  EXPECT_EQ(Floor{.height_m = 2}.height(3, 4), 2);
}

TEST(Route, RoundedSquareHasItsLengthAndKeepsItsRadius) {
  const Route loop = rounded_loop("loop", {{2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}}, 1.0, 0.5);
  EXPECT_NEAR(route_length_m(loop), 16 - 8 + 2 * std::numbers::pi, 0.02);
  EXPECT_EQ(loop.points_world.front(), Vec3(0, -2, 0));
  for (const Vec3& p : loop.points_world) {
    if (std::abs(p.x()) <= 1 || std::abs(p.y()) <= 1) continue;
    EXPECT_NEAR((Eigen::Vector2d(std::abs(p.x()), std::abs(p.y())) - Eigen::Vector2d(1, 1)).norm(), 1, 1e-9);
  }
}

TEST(Route, ArcsShrinkOnShortSides) {
  const Route loop = rounded_loop("loop", {{0.5, -2, 0}, {0.5, 2, 0}, {-0.5, 2, 0}, {-0.5, -2, 0}}, 3.0, 0.5);
  for (const Vec3& p : loop.points_world) EXPECT_LE(std::abs(p.x()), 0.5 + 1e-12);
  EXPECT_NEAR(route_length_m(loop), 2 * 3 + std::numbers::pi, 0.05);
}

TEST(Likeness, GoesFromEveryoneForThemselvesToAllAlike) {
  const Likeness own(1, 0), alike(1, 1);
  for (uint64_t member = 1; member < 20; ++member) {
    EXPECT_NE(own.choice("x", member), own.choice("x", 0));
    EXPECT_EQ(alike.choice("x", member), alike.choice("x", 0));
    EXPECT_NE(own.blend("x", member), own.blend("x", 0));
    EXPECT_EQ(alike.blend("x", member), alike.blend("x", 0));
  }
  int copies = 0;
  const Likeness half(1, 0.5);
  for (uint64_t member = 1; member <= 1000; ++member)
    copies += half.choice("x", member) == half.choice("x", 0);
  EXPECT_NEAR(copies, 500, 60);
}

fs::path library_file(std::string_view kind, std::string_view name) {
  return fs::path(VSSLAM_SOURCE_DIR) / kind / "library" / (std::string(name) + ".yaml");
}

TEST(WorldSource, EveryLibraryFileMakesAWorld) {
  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(VSSLAM_SOURCE_DIR) / "worlds/library")) {
    WorldSource source;
    load_config(entry.path(), source, library_file);
    source.corridor.textures = source.room.textures = false;
    EXPECT_GT(make_world(source).triangle_count(), 1000u) << entry.path();
    WorldSource again;
    load_config_text(save_config(source), "saved.yaml", again, library_file);
    EXPECT_EQ(save_config(again), save_config(source));
    ++files;
  }
  EXPECT_GE(files, 5u);
}

TEST(WorldSource, OverridesAndWrongKeys) {
  WorldSource source;
  load_config(library_file("worlds", "corridor_jambs"), source, library_file, {{"length_m", "120"}});
  EXPECT_EQ(source.corridor.length_m, 120);
  EXPECT_EQ(source.corridor.jamb_depth_m, 0.15);
  EXPECT_EQ(source.corridor.symmetry, 0.9);
  const auto error = [](const std::string& yaml) -> std::string {
    WorldSource s;
    try {
      load_config_text(yaml, "w.yaml", s, library_file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(error("corridor: {lenght_m: 3}\n"),
            "w.yaml:1:12: unknown key \"lenght_m\" (did you mean length_m?)");
  EXPECT_NE(error("corridor: {breadth_m: 9, lobby_width_m: 8}\n").find("room for the lobbies"),
            std::string::npos);
  EXPECT_NE(error("room: {length_m: 12}\n"), "");  // the generator is corridor
  EXPECT_EQ(error("generator: room\nroom: {length_m: 12}\n"), "");
}

TEST(WorldSource, FilesAreRelativeToWhoNamesThem) {
  const fs::path folder = scratch_folder() / "named_world";
  fs::create_directories(folder);
  RoomConfig room;
  room.textures = false;
  const World world = make_room(room);
  write_glb(world, folder / "room.glb");
  write_file(folder / "room.yaml", "file: room.glb\n");
  WorldSource source;
  load_config(folder / "room.yaml", source, library_file);
  EXPECT_EQ(make_world(source).triangle_count(), world.triangle_count());
  // What a run saves is a valid scenario from anywhere.
  WorldSource again;
  load_config_text(save_config(source), "saved.yaml", again, library_file);
  EXPECT_EQ(make_world(again).triangle_count(), world.triangle_count());
  EXPECT_THROW(make_world({.file = "nowhere.glb", .corridor = {}, .room = {}, .street = {}, .gate = {}}),
               InputError);
}

TEST(Describe, NamesWhatThereIs) {
  RoomConfig config;
  config.textures = false;
  const World world = make_room(config);
  const std::string text = describe(world);
  for (const char* part :
       {"world room", "size: 12.00 x 10.30 x 3.05 m", "glass", "retro-reflective", "loop", "lamp"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

}  // namespace
}  // namespace vsslam
