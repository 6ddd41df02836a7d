// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/orphans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "packer/zones/findings.hpp"

namespace zonepack::packer {
namespace {

// How a signature's position would have to be written to lie where the zones were drawn.
struct Reading {
  const char* how;
  const char* remedy;
  double xx, xy, yx, yy;  // x' = xx x + xy y, y' = yx x + yy y
};

constexpr double kFeetPerMetre = 1 / 0.3048;

constexpr std::array<Reading, 9> kReadings = {{
    {"x and y swapped", "write each position as [x, y]", 0, 1, 1, 0},
    {"x mirrored", "turn the sign of every x", -1, 0, 0, 1},
    {"y mirrored", "turn the sign of every y; in an image y points down, in the map up", 1, 0, 0,
     -1},
    {"a half turn", "turn the drawing by 180 degrees around (0, 0)", -1, 0, 0, -1},
    {"a quarter turn to the left", "turn the drawing by 90 degrees to the left around (0, 0)", 0, 1,
     -1, 0},
    {"a quarter turn to the right", "turn the drawing by 90 degrees to the right around (0, 0)", 0,
     -1, 1, 0},
    {"coordinates read as centimetres", "divide every coordinate by 100", 100, 0, 0, 100},
    {"coordinates read as millimetres", "divide every coordinate by 1000", 1000, 0, 0, 1000},
    {"coordinates read as feet", "multiply every coordinate by 0.3048", kFeetPerMetre, 0, 0,
     kFeetPerMetre},
}};

std::string distance_text(double distance_m) {
  const double step = distance_m < 10 ? 10 : 1;
  return number_text(std::max(std::ceil(distance_m * step - 1e-6), 1.0) / step);
}

}  // namespace

std::vector<OrphanGroup> group_orphans(std::span<const Orphan> orphans) {
  std::map<std::pair<std::uint32_t, bool>, OrphanGroup> groups;
  for (const Orphan& orphan : orphans) {
    const bool far = orphan.distance_m > kNearOrphan_m;
    const auto [it, fresh] = groups.try_emplace({orphan.nearest_zone, far});
    OrphanGroup& group = it->second;
    if (fresh) group = {orphan.nearest_zone, 0, 0, orphan.id};
    ++group.count;
    group.farthest_m = std::max(group.farthest_m, orphan.distance_m);
  }
  std::vector<OrphanGroup> sorted;
  sorted.reserve(groups.size());
  for (const auto& [key, group] : groups) sorted.push_back(group);
  std::ranges::stable_sort(
      sorted, [](const OrphanGroup& a, const OrphanGroup& b) { return a.count > b.count; });
  return sorted;
}

std::string near_text(const OrphanGroup& group, std::span<const PlannedZone> zones) {
  const std::string& name = zones[group.nearest_zone].name;
  const std::string farthest = distance_text(group.farthest_m) + " m";
  if (group.farthest_m <= kNearOrphan_m) return "within " + farthest + " of " + name;
  return number_text(kNearOrphan_m) + " to " + farthest + " from " + name;
}

std::string groups_text(std::span<const OrphanGroup> groups, std::span<const PlannedZone> zones) {
  std::size_t count = 0;
  for (const OrphanGroup& group : groups) count += group.count;
  const OrphanGroup& most = groups.front();
  std::string text;
  if (most.count < count) {
    text = std::to_string(most.count) + " of them ";
  } else if (count > 1) {
    text = count == 2 ? "both " : "all ";
  }
  return text + near_text(most, zones);
}

std::string orphans_text(std::span<const OrphanGroup> groups, std::span<const PlannedZone> zones) {
  std::size_t count = 0;
  for (const OrphanGroup& group : groups) count += group.count;
  std::string text = std::to_string(count) + " in none";
  return groups.empty() ? text : text + ", " + groups_text(groups, zones);
}

std::optional<Misdrawn> find_misdrawn(std::span<const PlannedZone> zones,
                                      std::span<const SignaturePlace> places, std::size_t orphans) {
  if (orphans == 0 || orphans * 4 < places.size()) return std::nullopt;
  std::optional<Misdrawn> best;
  for (const Reading& reading : kReadings) {
    std::vector<SignaturePlace> read(places.begin(), places.end());
    for (SignaturePlace& place : read) {
      const Point2 p = place.p_map;
      place.p_map = {reading.xx * p.x_m + reading.xy * p.y_m,
                     reading.yx * p.x_m + reading.yy * p.y_m};
    }
    const std::size_t left = count_outside(zones, read);
    const bool much_better = left * 2 <= orphans && (orphans - left) * 4 >= places.size();
    if (!much_better || (best && left >= best->orphans)) continue;
    best = {reading.how, reading.remedy, left};
  }
  return best;
}

std::string misdrawn_text(const Misdrawn& misdrawn, std::size_t orphans, std::size_t signatures) {
  return std::to_string(orphans) + " of " + std::to_string(signatures) + " in no zone; with " +
         misdrawn.how + " " + std::to_string(misdrawn.orphans) +
         ": the zones seem to be drawn that way; " + misdrawn.remedy +
         ", in metres of the map frame";
}

}  // namespace zonepack::packer
