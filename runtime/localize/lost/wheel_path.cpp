// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/lost/wheel_path.hpp"

#include <algorithm>

#include "runtime/odometry/se2.hpp"

namespace zonepack::localize {

void WheelPath::add(std::int64_t t_ns, const Pose2& T_wheels_base) {
  if (!moments_.empty() && t_ns <= moments_.back().t_ns) return;
  moments_.push_back({t_ns, T_wheels_base});
  while (moments_.front().t_ns < t_ns - kept_ns_) moments_.pop_front();
}

std::optional<Pose2> WheelPath::at(std::int64_t t_ns) const noexcept {
  if (moments_.empty()) return std::nullopt;
  const auto after =
      std::lower_bound(moments_.begin(), moments_.end(), t_ns,
                       [](const Moment& moment, std::int64_t t) { return moment.t_ns < t; });
  if (after == moments_.end()) return moments_.back().pose;
  if (after == moments_.begin()) return after->pose;
  const Moment& before = *(after - 1);
  const double part =
      static_cast<double>(t_ns - before.t_ns) / static_cast<double>(after->t_ns - before.t_ns);
  const Pose2 step = between(before.pose, after->pose);
  return compose(before.pose, {step.x_m * part, step.y_m * part, step.yaw_rad * part});
}

}  // namespace zonepack::localize
