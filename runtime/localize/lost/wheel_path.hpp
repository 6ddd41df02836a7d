// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "runtime/odometry/pose.hpp"

namespace zonepack::localize {

// Where the robot was lately by its wheels alone, for images that come late.
//
// Memory: the moments of the time that is kept.
class WheelPath {
 public:
  explicit WheelPath(std::int64_t kept_ns) : kept_ns_(kept_ns) {}

  // In order of time: a moment that is not later than the last one is left out.
  void add(std::int64_t t_ns, const Pose2& T_wheels_base);
  // Between two moments on the straight way from one to the other; before the first and after the
  // last where these were. Nothing without any.
  std::optional<Pose2> at(std::int64_t t_ns) const noexcept;

 private:
  struct Moment {
    std::int64_t t_ns = 0;
    Pose2 pose;
  };
  std::int64_t kept_ns_;
  std::deque<Moment> moments_;
};

}  // namespace zonepack::localize
