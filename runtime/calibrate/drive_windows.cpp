// SPDX-License-Identifier: Apache-2.0
#include "runtime/calibrate/drive_windows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "runtime/odometry/se2.hpp"

namespace zonepack {

TrueMotionOf motion_on(const TruthTrack& track) {
  return [&track](std::int64_t from_ns, std::int64_t to_ns) -> std::optional<TrueMotion> {
    const auto from = track.at(from_ns);
    const auto to = track.at(to_ns);
    if (!from || !to) return std::nullopt;
    const Pose2 motion = between(*from, *to);
    // Along the chord of an arc, which leaves at half of the turn, and is shorter than the arc.
    const double half = motion.yaw_rad / 2;
    const double chord = motion.x_m * std::cos(half) + motion.y_m * std::sin(half);
    const double shorter = std::abs(half) < 1e-6 ? 1 : std::sin(half) / half;
    return TrueMotion{chord / shorter, motion.yaw_rad, true};
  };
}

std::optional<TruthTrack> track_of(const std::vector<PoseCorrection>& corrections) {
  std::vector<TruthTrack::Sample> samples;
  for (const PoseCorrection& fix : corrections) {
    if (is_finite(fix.T_map_base)) samples.push_back({fix.stamp_ns, fix.T_map_base});
  }
  const auto earlier = [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; };
  const auto same = [](const auto& a, const auto& b) { return a.t_ns == b.t_ns; };
  std::stable_sort(samples.begin(), samples.end(), earlier);
  samples.erase(std::unique(samples.begin(), samples.end(), same), samples.end());
  if (samples.size() < 2) return std::nullopt;
  return TruthTrack(std::move(samples));
}

void DriveWindows::add(const WheelStep& step) {
  if (!truth_ || !step.known) {
    begun_ = false;
    return;
  }
  if (!begun_) {
    open_ = {};
    from_ns_ = step.from_ns;
    begun_ = true;
  }
  open_.left_m += step.left_m;
  open_.right_m += step.right_m;
  open_.seconds = static_cast<double>(step.to_ns - from_ns_) * 1e-9;
  if (open_.seconds < kCalibrationWindow_s) return;
  begun_ = false;
  const auto truth = truth_(from_ns_, step.to_ns);
  if (!truth) return;
  open_.truth = *truth;
  if (windows_.size() == kMost) windows_.pop_front();
  windows_.push_back(open_);
}

void TwistTrack::add_forward(double m_s) {
  forward_m_s_ = m_s;
  forward_known_ = true;
}

void TwistTrack::add_yaw_rate(std::int64_t stamp_ns, double rad_s) {
  constexpr double kLongestStep_s = 1;
  Sample next{stamp_ns, {}};
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    const double seconds = static_cast<double>(stamp_ns - last.stamp_ns) * 1e-9;
    if (seconds <= 0) return;
    if (seconds > kLongestStep_s) {
      samples_.clear();
    } else {
      next.total = {last.total.forward_m + forward_m_s_ * seconds,
                    last.total.turn_rad + (yaw_rate_rad_s_ + rad_s) / 2 * seconds, true};
    }
  }
  yaw_rate_rad_s_ = rad_s;
  if (samples_.size() == kMost) samples_.pop_front();
  samples_.push_back(next);
}

std::optional<TrueMotion> TwistTrack::at(std::int64_t stamp_ns) const {
  const auto after =
      std::lower_bound(samples_.begin(), samples_.end(), stamp_ns,
                       [](const Sample& sample, std::int64_t at) { return sample.stamp_ns < at; });
  // The newest sample stands for the little time until the next one comes.
  constexpr std::int64_t kMostAhead_ns = 100'000'000;
  if (after == samples_.end()) {
    if (samples_.empty() || stamp_ns - samples_.back().stamp_ns > kMostAhead_ns) {
      return std::nullopt;
    }
    return samples_.back().total;
  }
  if (after == samples_.begin()) {
    if (after->stamp_ns - stamp_ns > kMostAhead_ns) return std::nullopt;
  }
  return after->total;
}

std::optional<TrueMotion> TwistTrack::between(std::int64_t from_ns, std::int64_t to_ns) const {
  const auto from = at(from_ns);
  const auto to = at(to_ns);
  if (!from || !to) return std::nullopt;
  return TrueMotion{to->forward_m - from->forward_m, to->turn_rad - from->turn_rad, forward_known_};
}

}  // namespace zonepack
