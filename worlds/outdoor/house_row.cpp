#include "worlds/outdoor/house_row.h"

#include <algorithm>
#include <cmath>

namespace vsslam {

namespace {

constexpr double kGap_m = 5.2, kShortest_m = 9, kLargestSetback_m = 1.2;

bool along_x(Facing front) {
  return front == Facing::north || front == Facing::south;
}

/// The part of the strip from a to b along the row, set back from its front.
Rect lot(const HouseRow& row, double a, double b, double setback) {
  Rect r = row.strip;
  (along_x(row.front) ? r.x0 : r.y0) = a;
  (along_x(row.front) ? r.x1 : r.y1) = b;
  switch (row.front) {
    case Facing::east:
      r.x1 -= setback;
      break;
    case Facing::north:
      r.y1 -= setback;
      break;
    case Facing::west:
      r.x0 += setback;
      break;
    case Facing::south:
      r.y0 += setback;
      break;
  }
  return r;
}

}  // namespace

HouseRowPlan plan_row(const HouseRow& row, const Likeness& like) {
  HouseRowPlan plan;
  const double begin = along_x(row.front) ? row.strip.x0 : row.strip.y0,
               end = along_x(row.front) ? row.strip.x1 : row.strip.y1;
  const Facing back = static_cast<Facing>((static_cast<int>(row.front) + 2) % 4);
  const Facing low = along_x(row.front) ? Facing::west : Facing::south,
               high = along_x(row.front) ? Facing::east : Facing::north;
  double at = begin;
  bool open = true;  // beside the next house
  for (uint64_t k = 0; end - at > kShortest_m; ++k) {
    const auto draw = [&](const char* what) { return like.choice(what, row.member, k); };
    double to = at + row.lot_m * (0.7 + 0.6 * draw("lot"));
    if (end - to < kGap_m + kShortest_m) to = end;
    const bool gap = to < end && draw("gap") < row.gap_share;
    Building house{.footprint = lot(row, at, to, kLargestSetback_m * draw("setback")),
                   .base_m = row.base_m,
                   .front = row.front,
                   .look = static_cast<uint64_t>(draw("look") * 0x1p52),
                   .lit_share = row.lit_share};
    house.floors =
        row.fewest_floors + static_cast<int>(draw("floors") * (row.most_floors - row.fewest_floors + 1));
    house.visible[static_cast<size_t>(low)] = open;
    house.visible[static_cast<size_t>(high)] = gap || to >= end;
    house.visible[static_cast<size_t>(back)] = row.visible_back;
    plan.houses.push_back(house);
    open = gap;
    at = to + (gap ? kGap_m : 0);
    if (gap) plan.gaps.push_back(lot(row, to, at, 0));
  }
  return plan;
}

}  // namespace vsslam
