// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/log_time.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "platform/can/can_log.hpp"

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

std::size_t LogTime::stretch_of(std::int64_t stamp_ns, std::size_t first) const noexcept {
  std::size_t nearest = first;
  std::int64_t least_ns = INT64_MAX;
  for (std::size_t i = first; i < stretches_.size(); ++i) {
    const Stretch& stretch = stretches_[i];
    const std::int64_t apart_ns =
        std::max<std::int64_t>({0, stretch.first_ns - stamp_ns, stamp_ns - stretch.last_ns});
    if (apart_ns >= least_ns) continue;
    least_ns = apart_ns;
    nearest = i;
  }
  return nearest;
}

std::int64_t LogTime::on_first_clock(std::int64_t stamp_ns) const noexcept {
  if (!steps()) return stamp_ns;
  return stamp_ns + stretches_[stretch_of(stamp_ns, 0)].added_ns;
}

std::vector<PoseCorrection> LogTime::on_first_clock(std::vector<PoseCorrection> as_written) const {
  if (steps()) {
    std::size_t now = 0;  // the stretch that the file has reached
    std::int64_t latest_ns = INT64_MIN;
    for (PoseCorrection& correction : as_written) {
      const std::int64_t received_ns = correction.received_ns;
      const bool set_back =
          latest_ns != INT64_MIN && latest_ns - received_ns > CanLogReader::kMostDisorder_ns;
      if (set_back && now + 1 < stretches_.size()) ++now;
      latest_ns = set_back ? received_ns : std::max(latest_ns, received_ns);
      now = stretch_of(received_ns, now);
      const std::int64_t added_ns = stretches_[now].added_ns;
      const std::int64_t waited_ns = received_ns - correction.stamp_ns;
      const bool same_stretch = waited_ns > -CanLogReader::kLongestSilence_ns &&
                                waited_ns < CanLogReader::kLongestSilence_ns;
      correction.received_ns += added_ns;
      correction.stamp_ns =
          same_stretch ? correction.stamp_ns + added_ns : on_first_clock(correction.stamp_ns);
    }
  }
  std::ranges::stable_sort(as_written, {}, &PoseCorrection::received_ns);
  return as_written;
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
