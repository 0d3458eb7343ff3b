#include <gtest/gtest.h>

#include "core/rng.h"
#include "slam/loop/descriptor_database.h"

namespace vsslam {
namespace {

// Contexts along a path: neighbours are alike.
ScanContext context_at(double place) {
  PolarHeights heights;
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSectors; ++j)
      heights(i, j) =
          static_cast<float>(1.5 + std::sin(0.9 * place + 0.7 * i * std::cos(0.31 * place + 0.2 * j)));
  return ScanContext(heights);
}

Time at(int key) {
  return Time::from_seconds(key);
}

TEST(DescriptorDatabase, FindsTheNearestAndTheRunnerUp) {
  DescriptorDatabase database(1000);
  for (int key = 0; key < 40; key += 2) database.add(key, at(key), context_at(key));
  const QueryDescriptor query{context_at(12.4), 0, {0, 0}};
  const auto match = database.find({&query, 1}, 20);
  ASSERT_TRUE(match);
  EXPECT_EQ(database.entries()[match->entry].key, 12);
  double second = 1;
  for (size_t i = 0; i < 20; ++i)
    if (i != match->entry)
      second = std::min(second, scan_context_distance(query.context, database.entries()[i].context).distance);
  ASSERT_TRUE(match->runner_up_distance);
  EXPECT_EQ(*match->runner_up_distance, second);
}

TEST(DescriptorDatabase, OnlyEligibleEntriesAreCompared) {
  DescriptorDatabase database(1000);
  const QueryDescriptor query{context_at(12), 0, {0, 0}};
  EXPECT_FALSE(database.find({&query, 1}, 0));
  for (int key = 0; key < 20; ++key) database.add(key, at(key), context_at(key));
  EXPECT_LT(database.find({&query, 1}, 10)->entry, 10u);
  EXPECT_EQ(database.find({&query, 1}, 20)->entry, 12u);
  EXPECT_FALSE(database.find({&query, 1}, 1)->runner_up_distance);
  EXPECT_EQ(database.count_until(9, at(100)), 10u);
  EXPECT_EQ(database.count_until(100, at(4)), 5u);
  EXPECT_EQ(database.count_until(-1, at(100)), 0u);
}

TEST(DescriptorDatabase, FindsOnlyWhatMayMatch) {
  DescriptorDatabase all_pairs(1000), ring_keys(0);
  const QueryDescriptor query{context_at(1.2), 0, {0, 0}};
  const auto odd = [](const DescriptorDatabase::Entry& entry) { return entry.key % 2 == 1; };
  for (DescriptorDatabase* database : {&all_pairs, &ring_keys}) {
    for (int key = 0; key < 20; ++key) database->add(key, at(key), context_at(0.1 * key));
    const auto match = database->find({&query, 1}, 20, odd);
    ASSERT_TRUE(match);
    EXPECT_TRUE(match->entry == 11 || match->entry == 13) << match->entry;
    EXPECT_FALSE(database->find({&query, 1}, 20, [](const DescriptorDatabase::Entry&) { return false; }));
  }
}

TEST(DescriptorDatabase, TiesGoToTheLowerEntryThenTheLowerDescriptor) {
  DescriptorDatabase database(1000);
  for (int key = 0; key < 5; ++key) database.add(key, at(key), context_at(key == 0 ? 50 : 3));
  const std::vector<QueryDescriptor> query{
      {context_at(90), 0, {0, 0}}, {context_at(3), 1, {1, 0}}, {context_at(3), 2, {2, 0}}};
  const auto match = database.find(query, 5);
  EXPECT_EQ(match->entry, 1u);
  EXPECT_EQ(match->descriptor, 1u);
}

TEST(DescriptorDatabase, RingKeysOfALargeDatabaseFindWhatAllPairsFind) {
  DescriptorDatabase all(1 << 20), prefiltered(0);
  const RandomStream places(1, "places");
  int agree = 0;
  for (int key = 0; key < 400; ++key) {
    const double place = 100 * places.uniform(static_cast<uint64_t>(key));
    const QueryDescriptor query[2] = {{context_at(place + 0.01), 0, {0, 0}},
                                      {context_at(place + 50), 1, {1, 0}}};
    // Every entry added so far can be found at once.
    const auto a = all.find(query, all.entries().size()), b = prefiltered.find(query, all.entries().size());
    EXPECT_EQ(a.has_value(), b.has_value());
    if (a && b) {
      EXPECT_LE(a->best.distance, b->best.distance);
      agree += a->entry == b->entry;
    }
    all.add(key, at(key), context_at(place));
    prefiltered.add(key, at(key), context_at(place));
    const QueryDescriptor same{context_at(place), 0, {0, 0}};
    EXPECT_NEAR(prefiltered.find({&same, 1}, all.entries().size())->best.distance, 0, 1e-6);
  }
  EXPECT_GT(agree, 380);
}

}  // namespace
}  // namespace vsslam
