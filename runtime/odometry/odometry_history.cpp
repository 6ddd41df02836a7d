// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/odometry_history.hpp"

#include <algorithm>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

Covariance2 scaled(const Covariance2& c, double by) noexcept {
  return {c.xx * by, c.xy * by, c.x_yaw * by, c.yy * by, c.y_yaw * by, c.yaw_yaw * by};
}

}  // namespace

OdometryHistory::OdometryHistory(std::size_t capacity)
    : entries_(std::max<std::size_t>(capacity, 2)) {}

void OdometryHistory::restart(std::int64_t t_ns) noexcept {
  first_ += count_;
  count_ = 1;
  back() = Entry{};
  back().t_ns = t_ns;
}

OdometryHistory::Entry& OdometryHistory::push(std::int64_t t_ns,
                                              const UncertainPose& step) noexcept {
  ZP_REQUIRE(count_ > 0 && t_ns >= back().t_ns);
  const UncertainPose state = compose(back().state, step);
  if (full()) {
    ++first_;
  } else {
    ++count_;
  }
  back() = {t_ns, step, state, {}, false};
  return back();
}

std::optional<std::uint64_t> OdometryHistory::find(std::int64_t t_ns) const noexcept {
  if (empty() || t_ns < at(oldest()).t_ns || t_ns > back().t_ns) return std::nullopt;
  std::uint64_t low = oldest();
  std::uint64_t high = newest();
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    if (at(middle).t_ns < t_ns) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

UncertainPose OdometryHistory::carry_to_entry(const UncertainPose& pose, std::int64_t t_ns,
                                              std::uint64_t index) const noexcept {
  const Entry& entry = at(index);
  if (entry.t_ns == t_ns) return pose;
  const std::int64_t begin_ns = at(index - 1).t_ns;
  const double part =
      static_cast<double>(t_ns - begin_ns) / static_cast<double>(entry.t_ns - begin_ns);
  const Pose2 rest = between(part_of_arc(entry.step.pose, part), entry.step.pose);
  return compose(pose, UncertainPose{rest, scaled(entry.step.covariance, 1 - part)});
}

UncertainPose OdometryHistory::carry(UncertainPose pose, std::uint64_t from,
                                     std::uint64_t to) const noexcept {
  for (std::uint64_t i = from; i < to; ++i) pose = compose(pose, at(i + 1).step);
  return pose;
}

void OdometryHistory::replay_from(std::uint64_t from) noexcept {
  for (std::uint64_t i = from; i < newest(); ++i) {
    Entry& next = at(i + 1);
    next.state = compose(at(i).state, next.step);
    if (next.has_fix) next.state = fuse(next.state, next.fix);
  }
}

}  // namespace zonepack
