// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/pack_format/file/geometry.hpp"

// What moves on a report's plan when its page is played: where the robot was, and which zones were
// in memory. Times are seconds since the start of the run; zones count as in the plan.
namespace zonepack::report {

struct PlayPose {
  double t_s = 0;
  bool known = false;
  Point2 p_map;
  double yaw_rad = 0;
};

// A zone that took memory from `from_s` to `to_s`, usable from `ready_s` on (to_s: never).
struct PlayHold {
  std::size_t zone = 0;
  double from_s = 0, ready_s = 0, to_s = 0;
};

struct PlayStay {
  std::size_t zone = 0;  // that the robot believed to be in
  double from_s = 0, to_s = 0;
};

struct PlayEvent {
  static constexpr std::size_t kNoZone = static_cast<std::size_t>(-1);
  double t_s = 0;
  std::string kind;
  std::size_t zone = kNoZone;
};

struct Playback {
  double duration_s = 0;
  std::vector<PlayPose> poses;  // by time, as all below
  std::vector<PlayHold> holds;
  std::vector<PlayStay> stays;
  std::vector<PlayEvent> events;
};

// For the page's script. Of the poses so many are kept that lines between them miss none by 1 cm
// and 0.02 rad, or more coarsely once they are kMostPoses; of the stays the longest kMostStays. A
// page with all of that full takes about 1.5 MB of it.
inline constexpr std::size_t kMostPoses = 20'000;
inline constexpr std::size_t kMostStays = 20'000;
std::string playback_json(const Playback& playback);

}  // namespace zonepack::report
