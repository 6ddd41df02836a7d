// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

// How well zones match rooms, by cells: of each room, the zone that holds most of it.
namespace zonepack::bench {

struct RoomScores {
  double iou = 0, mcc = 0;  // sums over rooms
  double worst_iou = 1;
  std::size_t rooms = 0, zones = 0;
  std::size_t cells = 0, outside = 0;  // of rooms; in no zone
  std::size_t poor = 0;                // rooms with an IoU under 0.6

  void add(const RoomScores& other) {
    iou += other.iou;
    mcc += other.mcc;
    worst_iou = std::min(worst_iou, other.worst_iou);
    rooms += other.rooms;
    zones += other.zones;
    cells += other.cells;
    outside += other.outside;
    poor += other.poor;
  }
};

// Parallel lists: the room and the zone of each cell, -1 for none. MCC is Matthews' correlation
// coefficient of "in the room" and "in the zone" over all cells of rooms.
inline RoomScores score_rooms(const std::vector<std::int32_t>& room_of,
                              const std::vector<std::int32_t>& zone_of) {
  std::map<std::int32_t, double> rooms, zones;
  std::map<std::int32_t, std::map<std::int32_t, double>> common;
  RoomScores scores;
  for (std::size_t i = 0; i < room_of.size(); ++i) {
    if (room_of[i] < 0) continue;
    ++scores.cells;
    ++rooms[room_of[i]];
    if (zone_of[i] < 0) {
      ++scores.outside;
    } else {
      ++zones[zone_of[i]];
      ++common[room_of[i]][zone_of[i]];
    }
  }
  const auto all = static_cast<double>(scores.cells);
  for (const auto& [room, cells] : rooms) {
    std::pair<std::int32_t, double> best{-1, 0};
    for (const auto& [zone, shared] : common[room]) {
      if (shared > best.second) best = {zone, shared};
    }
    const double tp = best.second, fp = best.first < 0 ? 0 : zones[best.first] - tp;
    const double fn = cells - tp, tn = all - tp - fp - fn;
    const double iou = tp / (tp + fp + fn);
    const double root = std::sqrt((tp + fp) * (tp + fn) * (tn + fp) * (tn + fn));
    scores.iou += iou;
    scores.mcc += root > 0 ? (tp * tn - fp * fn) / root : tp > 0 ? 1 : 0;
    scores.worst_iou = std::min(scores.worst_iou, iou);
    if (iou < 0.6) ++scores.poor;
    ++scores.rooms;
  }
  scores.zones = zones.size();
  return scores;
}

}  // namespace zonepack::bench
