// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/localize/query/stored_map.hpp"
#include "runtime/odometry/pose.hpp"

namespace zonepack::localize {

// How far a simulated map is off the truth: its signatures know where they really were. A fix can
// be no better to the truth than the map is; to judge the localizer alone, the truth is moved by
// the map's own error. Only for figures: reads the whole map, also what is not resident.
//
// Memory: 48 bytes a signature.
class MapError {
 public:
  // Reads the signatures' poses. Without a true pose in any of them, empty().
  static Outcome<MapError> read(const StoredMap& map);

  bool empty() const noexcept { return places_.empty(); }

  // Where the map has what is really at `truth`, by the signature that was really nearest, in
  // place and in where it looked: a map bends from one pass of its drive to the next, and where two
  // passes went opposite ways the camera sees what one of them saw.
  std::optional<Pose2> in_map(const Pose2& truth, double metres_a_radian = 1) const noexcept;

 private:
  struct Place {
    Pose2 T_world_base, T_map_base;
  };
  std::vector<Place> places_;
};

}  // namespace zonepack::localize
