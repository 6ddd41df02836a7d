// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "runtime/odometry/pose.hpp"
#include "runtime/zones/zone_graph.hpp"

namespace zonepack {

// The zones that a camera on the robot sees into, through portals: those that one of a fan of rays
// enters within `view_m`, 40 degrees to each side of the heading. Walls have no thickness and no
// furniture stands in the way.
//
// Real-time: no allocation; at most kRays * (kMostHops + 1) zones' portals are tested.
class ZonesInView {
 public:
  static constexpr std::size_t kMost = 6;
  static constexpr int kRays = 9;
  static constexpr int kMostHops = 3;  // portals that a ray passes

  // Looks from a pose in `zone`, which is not listed. Of more than kMost the nearest.
  ZonesInView(const ZoneGraph& graph, const Pose2& T_map_base, ZoneId zone, double view_m) noexcept;

  // The one entered after the shortest way first, then the lowest ZoneId.
  std::span<const ZoneId> zones() const noexcept { return {zones_.data(), count_}; }

 private:
  void follow_ray(const ZoneGraph& graph, Point2 from, Point2 to, ZoneId zone,
                  double view_m) noexcept;
  void see(ZoneId zone, double way_m) noexcept;

  std::array<ZoneId, kMost> zones_{};
  std::array<double, kMost> ways_m_{};
  std::size_t count_ = 0;
};

}  // namespace zonepack
