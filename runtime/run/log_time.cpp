// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/log_time.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "platform/can_log.hpp"

namespace zonepack {

LogTime LogTime::read(const std::string& path, const std::string& interface) {
  LogTime time;
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return time;
  CanLogReader log(path, interface);
  if (!log.open()) return time;
  std::uint64_t steps = 0;
  while (const auto frame = log.next()) {
    const std::int64_t stamp_ns = frame->stamp_ns - log.added_ns();
    const bool stepped = log.summary().clock_steps != steps;
    steps = log.summary().clock_steps;
    if (time.stretches_.empty() || (stepped && time.stretches_.size() < kMostStretches)) {
      time.stretches_.push_back({stamp_ns, stamp_ns, log.added_ns()});
    }
    Stretch& now = time.stretches_.back();
    now.first_ns = std::min(now.first_ns, stamp_ns);
    now.last_ns = std::max(now.last_ns, stamp_ns);
  }
  return time;
}

std::int64_t LogTime::on_first_clock(std::int64_t stamp_ns) const noexcept {
  std::int64_t least_ns = INT64_MAX, added_ns = 0;
  for (const Stretch& stretch : stretches_) {
    const std::int64_t apart_ns =
        std::max<std::int64_t>({0, stretch.first_ns - stamp_ns, stamp_ns - stretch.last_ns});
    if (apart_ns > least_ns) continue;
    least_ns = apart_ns;
    added_ns = stretch.added_ns;
  }
  return stamp_ns + added_ns;
}

std::vector<PoseCorrection> LogTime::on_first_clock(std::vector<PoseCorrection> corrections) const {
  if (!steps()) return corrections;
  for (PoseCorrection& correction : corrections) {
    correction.stamp_ns = on_first_clock(correction.stamp_ns);
    correction.received_ns = on_first_clock(correction.received_ns);
  }
  std::ranges::stable_sort(corrections, {}, &PoseCorrection::received_ns);
  return corrections;
}

TruthTrack LogTime::on_first_clock(const TruthTrack& truth) const {
  std::vector<TruthTrack::Sample> samples = truth.samples();
  if (steps()) {
    for (TruthTrack::Sample& sample : samples) sample.t_ns = on_first_clock(sample.t_ns);
    std::ranges::stable_sort(samples, {}, &TruthTrack::Sample::t_ns);
  }
  return TruthTrack(std::move(samples));
}

}  // namespace zonepack
