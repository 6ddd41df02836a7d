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
  back() = {t_ns, step, state, {}, false, false};
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

void OdometryHistory::split(std::uint64_t index, std::int64_t t_ns) noexcept {
  Entry first = at(index);
  const std::int64_t begin_ns = at(index - 1).t_ns;
  const double part =
      static_cast<double>(t_ns - begin_ns) / static_cast<double>(first.t_ns - begin_ns);
  const Pose2 whole = first.step.pose;
  const Covariance2 noise = first.step.covariance;
  push(back().t_ns, {});
  for (std::uint64_t i = newest(); i > index; --i) at(i) = at(i - 1);
  first.t_ns = t_ns;
  first.has_fix = false;
  first.step = {part_of_arc(whole, part), scaled(noise, part)};
  first.state = compose(at(index - 1).state, first.step);
  at(index) = first;
  at(index + 1).step = {between(first.step.pose, whole), scaled(noise, 1 - part)};
}

std::uint64_t OdometryHistory::fill_drift(std::int64_t from_ns, std::int64_t to_ns,
                                          const UncertainPose& motion) noexcept {
  std::uint64_t first = newest() + 1;
  while (first - 1 > oldest() && at(first - 1).drift && at(first - 2).t_ns >= from_ns) --first;
  std::uint64_t before = first - 1;
  if (full() && before == oldest()) from_ns = std::max(from_ns, at(before).t_ns);
  const double length = static_cast<double>(to_ns - from_ns);
  const auto part_at = [&](std::int64_t t_ns) {
    return length <= 0 ? 0 : std::clamp(static_cast<double>(t_ns - from_ns) / length, 0.0, 1.0);
  };
  const auto piece = [&](double begin, double end) {
    return UncertainPose{between(part_of_arc(motion.pose, begin), part_of_arc(motion.pose, end)),
                         scaled(motion.covariance, end - begin)};
  };
  bool fixed = false;
  for (std::uint64_t i = first; i <= newest(); ++i) fixed = fixed || at(i).has_fix;
  double done = part_at(at(before).t_ns);
  for (std::uint64_t i = first; i <= newest(); ++i) {
    const double reached = part_at(at(i).t_ns);
    const Covariance2 doubt = at(i).step.covariance;
    at(i).step = piece(done, reached);
    if (fixed) at(i).step.covariance = doubt;
    at(i).drift = false;
    done = reached;
  }
  if (full() && before == oldest()) ++before;
  push(std::max(to_ns, back().t_ns), piece(done, 1));
  return before;
}

void OdometryHistory::replay_from(std::uint64_t from) noexcept {
  for (std::uint64_t i = from; i < newest(); ++i) {
    Entry& next = at(i + 1);
    next.state = compose(at(i).state, next.step);
    if (next.has_fix) next.state = fuse(next.state, next.fix);
  }
}

}  // namespace zonepack
