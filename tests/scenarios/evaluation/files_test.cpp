#include "core/files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/errors.h"
#include "scenarios/evaluation/csv.h"
#include "scenarios/evaluation/trajectory_file.h"
#include "tests/scratch.h"

namespace vsslam {
namespace {

using testing::HasSubstr;
using testing::Not;

std::filesystem::path file(const char* name) {
  return scratch_folder() / name;
}

template <class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string tum_error(const std::string& text) {
  return error_of([&] { parse_tum(text, "x.tum"); });
}

TEST(Tum, ReadsCommentsBlankLinesAndExactStamps) {
  const PoseTrajectory trajectory = parse_tum(
      "# t x y z qx qy qz qw\n\n1700000000.123456789 1 2 3 0 0 0 1\n  # more\r\n"
      "1700000000.2234567894\t1e0 +2 -3.5 0 0 1 0\r\n",
      "x.tum");
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].stamp.ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(trajectory[1].stamp.ns, 1'700'000'000'223'456'789);
  EXPECT_EQ(trajectory[1].pose.translation, Vec3(1, 2, -3.5));
  EXPECT_EQ(trajectory[1].pose.rotation.z(), 1);
}

TEST(Tum, ReadsStampsInNanoseconds) {
  const PoseTrajectory trajectory =
      parse_tum("1700000000123456789.000000 1 2 3 0 0 0 1\n1700000000223456789 1 0 0 0 0 0 1\n", "x.tum");
  EXPECT_EQ(trajectory[0].stamp.ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(trajectory[1].stamp.ns, 1'700'000'000'223'456'789);
}

TEST(Tum, ErrorsHaveAPlace) {
  const std::string good = "0 0 0 0 0 0 0 1\n";
  EXPECT_THAT(tum_error(good + "1 0 0 0 0 0 1\n"), HasSubstr("x.tum:2: 7 columns, expected 8"));
  EXPECT_THAT(tum_error(good + "#\n1 0 0 0 0 0 0 1 9\n"), HasSubstr("x.tum:3: 9 columns"));
  EXPECT_THAT(tum_error(good + "1 nan 0 0 0 0 0 1\n"), HasSubstr("x.tum:2: column 2"));
  EXPECT_THAT(tum_error(good + "1 0 inf 0 0 0 0 1\n"), HasSubstr("x.tum:2: column 3"));
  EXPECT_THAT(tum_error(good + "1 0 0 2m 0 0 0 1\n"), HasSubstr("found \"2m\""));
  EXPECT_THAT(tum_error(good + "0 0 0 0 0 0 0 1\n"), HasSubstr("x.tum:2: stamp 0.000000000 is not after"));
  EXPECT_THAT(tum_error(good + "1 0 0 0 0 0 0 0\n"), HasSubstr("x.tum:2: quaternion of length 0"));
  EXPECT_THAT(tum_error(good + "1 0 0 0 0 0 0 2\n"), HasSubstr("quaternion of length 2"));
  EXPECT_THAT(tum_error(good + "1e18 0 0 0 0 0 0 1\n"), HasSubstr("x.tum:2: column 1: expected seconds"));
  EXPECT_THAT(tum_error(good + "1700000000000000000.5 0 0 0 0 0 0 1\n"), HasSubstr("column 1"));
  EXPECT_THAT(tum_error(good + "1e300 0 0 0 0 0 0 1\n"), HasSubstr("x.tum:2: column 1: expected seconds"));
  EXPECT_THAT(tum_error(good + "1 1e300 0 0 0 0 0 1\n"), HasSubstr("absurd"));
  EXPECT_THAT(tum_error("# nothing\n"), HasSubstr("x.tum: no pose"));
  EXPECT_THAT(tum_error(""), HasSubstr("x.tum: no pose"));
  EXPECT_THAT(error_of([] { read_tum(file("absent.tum")); }), HasSubstr("absent.tum"));
}

TEST(Tum, RoundTripsToANanometre) {
  PoseTrajectory trajectory;
  for (int i = -2; i < 20; ++i)
    trajectory.push_back(
        {Time{i * 100'000'001}, SE3::from_rpy({0.1 * i, 0.02 * i, 0.3 * i}, {1.5 * i, -2.25 * i, 0})});
  write_tum(file("a.tum"), trajectory);
  const PoseTrajectory again = read_tum(file("a.tum"));
  ASSERT_EQ(again.size(), trajectory.size());
  for (size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].stamp, trajectory[i].stamp);
    EXPECT_LT((again[i].pose.inverse() * trajectory[i].pose).log().norm(), 1e-8);
  }
  EXPECT_THAT(read_file(file("a.tum")), Not(HasSubstr("-0.000000000 ")));
}

TEST(Kitti, RoundTripsWithTimesBesideIt) {
  PoseTrajectory trajectory;
  for (int i = 0; i < 5; ++i)
    trajectory.push_back(
        {Time{i * 120'000'000}, SE3::from_rpy({0.1 * i, -0.2 * i, 0.3 * i}, {1.0 * i, 2, 3})});
  write_kitti(file("kitti/poses.txt"), trajectory);
  write_kitti_times(file("kitti/times.txt"), trajectory);
  const PoseTrajectory again = read_trajectory(file("kitti/poses.txt"));
  ASSERT_EQ(again.size(), 5u);
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(again[i].stamp, trajectory[i].stamp);
    EXPECT_LT((again[i].pose.inverse() * trajectory[i].pose).log().norm(), 1e-7);
  }
  EXPECT_EQ(read_kitti(file("kitti/poses.txt"))[3].stamp.ns, 300'000'000);
}

// ./vsslam evaluate <(...) truth.tum: what comes through a pipe can be read once.
TEST(Trajectory, ComesThroughAPipeToo) {
  const std::string tum = "1 0 0 0 0 0 0 1\n2 3 0 0 0 0 0 1\n", kitti = "1 0 0 7 0 1 0 0 0 0 1 0\n";
  const auto through_a_pipe = [](const std::string& text) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    EXPECT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    ::close(ends[1]);
    PoseTrajectory trajectory = read_trajectory(fmt::format("/dev/fd/{}", ends[0]));
    ::close(ends[0]);
    return trajectory;
  };
  EXPECT_EQ(through_a_pipe(tum).back().pose.translation.x(), 3);
  EXPECT_EQ(through_a_pipe(kitti).back().pose.translation.x(), 7);
}

TEST(Kitti, ErrorsHaveAPlace) {
  const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const auto error = [&](const std::string& poses, const std::string& times) {
    write_file(file("k.txt"), poses);
    write_file(file("t.txt"), times);
    return error_of(
        [&] { read_kitti(file("k.txt"), times.empty() ? std::filesystem::path() : file("t.txt")); });
  };
  EXPECT_THAT(error(identity + "1 0 0 0 0 1 0 0 0 0 1\n", ""), HasSubstr("k.txt:2: 11 columns, expected 12"));
  EXPECT_THAT(error("2 0 0 0 0 1 0 0 0 0 1 0\n", ""), HasSubstr("k.txt:1: the 3 x 3 part is not a rotation"));
  EXPECT_THAT(error("1 0 0 0 0 1 0 0 0 0 -1 0\n", ""), HasSubstr("not a rotation"));
  EXPECT_THAT(error(identity, "0\n1\n"), HasSubstr("t.txt:2: more stamps"));
  EXPECT_THAT(error(identity + identity, "0\n"), HasSubstr("1 stamps for 2 poses"));
  EXPECT_THAT(error(identity + identity, "1\n1\n"), HasSubstr("t.txt:2: stamp"));
}

TEST(Seconds, ToTheNanosecond) {
  EXPECT_EQ(parse_seconds("0.1")->ns, 100'000'000);
  EXPECT_EQ(parse_seconds("-1.5")->ns, -1'500'000'000);
  EXPECT_EQ(parse_seconds("12")->ns, 12'000'000'000);
  EXPECT_EQ(parse_seconds(".25")->ns, 250'000'000);
  EXPECT_EQ(parse_seconds("1.5e2")->ns, 150'000'000'000);
  EXPECT_EQ(parse_seconds("0.0000000006")->ns, 1);
  for (const char* bad : {"", ".", "-", "1.2.3", "nan", "inf", "1s", "0x10", "1e40", "99999999999999999999"})
    EXPECT_FALSE(parse_seconds(bad)) << bad;
  EXPECT_EQ(format_seconds(Time{-1}), "-0.000000001");
  EXPECT_EQ(format_seconds(Time{1'234'000'000'000}), "1234.000000000");
}

TEST(Csv, RoundTrips) {
  const std::array columns = {"name", "value", "count", "stamp"};
  CsvWriter csv(columns);
  csv("plain")(0.1)(3)(Time{5}).end_row();
  csv("a, \"quoted\"\nname")(-1e-300)(-7)(Time{-1'000'000'000}).end_row();
  csv("").empty(2)(Time{0}).end_row();
  EXPECT_THAT(csv.text(), HasSubstr("name,value,count,stamp\nplain,0.1,3,0.000000005\n"));
  const CsvTable table = CsvTable::parse(csv.text(), "x.csv");
  ASSERT_EQ(table.rows(), 3u);
  EXPECT_EQ(table.text(1, "name"), "a, \"quoted\"\nname");
  EXPECT_EQ(table.number(1, "value"), -1e-300);
  EXPECT_EQ(table.integer(1, "count"), -7);
  EXPECT_FALSE(table.maybe_number(2, "value"));
  EXPECT_EQ(table.maybe_number(0, "value"), 0.1);
}

TEST(Csv, PosesAreWrittenWithPositiveScalarPart) {
  const std::array columns = {"x", "y", "z", "qx", "qy", "qz", "qw"};
  CsvWriter csv(columns);
  csv(SE3(Quat(-0.5, 0.5, 0.5, -0.5), {1, 2, 3})).end_row();
  EXPECT_EQ(csv.text(), "x,y,z,qx,qy,qz,qw\n1,2,3,-0.5,-0.5,0.5,0.5\n");
}

TEST(Csv, ErrorsHaveAPlace) {
  const auto error = [](const char* text, auto use) {
    return error_of([&] { use(CsvTable::parse(text, "x.csv")); });
  };
  const auto nothing = [](const CsvTable&) {};
  EXPECT_THAT(error("", nothing), HasSubstr("x.csv:1: empty"));
  EXPECT_THAT(error("a,b\n1,2\n3\n", nothing), HasSubstr("x.csv:3: 1 fields, expected 2"));
  EXPECT_THAT(error("a,a\n", nothing), HasSubstr("\"a\" appears twice"));
  EXPECT_THAT(error("a\n1\n\"2\n", nothing), HasSubstr("x.csv:3: a quoted field"));
  EXPECT_THAT(error("a,b\n1,\n", [](const CsvTable& t) { t.number(0, "b"); }),
              HasSubstr("x.csv:2: column \"b\": expected a number, found \"\""));
  EXPECT_THAT(error("a\nnan\n", [](const CsvTable& t) { t.number(0, "a"); }), HasSubstr("x.csv:2"));
  EXPECT_THAT(error("a\n\"1\n\"\n2.5\n", [](const CsvTable& t) { t.integer(1, "a"); }),
              HasSubstr("x.csv:4: column \"a\": expected an integer"));
  EXPECT_THAT(error("a\n1\n", [](const CsvTable& t) { t.number(0, "b"); }), HasSubstr("no column \"b\""));
  EXPECT_THAT(error("a\n1\n",
                    [](const CsvTable& t) {
                      t.require(std::array{"a", "b", "c"});
                    }),
              HasSubstr("missing columns: \"b\", \"c\""));
}

TEST(Csv, ARowOfTheWrongLengthIsOurBug) {
  const std::array columns = {"a", "b"};
  CsvWriter csv(columns);
  csv(1);
  EXPECT_THROW(csv.end_row(), std::logic_error);
}

}  // namespace
}  // namespace vsslam
