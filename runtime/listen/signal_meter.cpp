// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/signal_meter.hpp"

#include <algorithm>

namespace zonepack {
namespace {

double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

double per_second(double count, double over_s) { return over_s > 0 ? count / over_s : 0; }

}  // namespace

void SignalMeter::add(std::int64_t stamp_ns, double sum) {
  if (count_++ == 0) first_ns_ = stamp_ns;
  if (newest_.size() == kMost) newest_.pop_front();
  newest_.push_back({stamp_ns, sum});
}

double SignalMeter::rate_hz(std::int64_t now_ns) const noexcept {
  if (newest_.size() < 2) return 0;
  const double between = static_cast<double>(newest_.size() - 1);
  const double spread = seconds(newest_.front().stamp_ns, newest_.back().stamp_ns);
  const double silent = seconds(newest_.back().stamp_ns, now_ns);
  // As long as the next one is not overdue, silence says nothing.
  const double overdue = std::max(0.0, silent - 2 * spread / between);
  return per_second(between, spread + overdue);
}

double SignalMeter::mean_rate_hz() const noexcept {
  if (count_ < 2) return 0;
  return per_second(static_cast<double>(count_ - 1), seconds(first_ns_, last_ns()));
}

double SignalMeter::slope_per_s() const noexcept {
  if (newest_.size() < 2) return 0;
  const Sample& last = newest_.back();
  const Sample* first = &newest_[newest_.size() - 2];
  for (const Sample& sample : newest_) {
    if (seconds(sample.stamp_ns, last.stamp_ns) > kOver_s) continue;
    if (&sample != &last) first = &sample;
    break;
  }
  const double over = seconds(first->stamp_ns, last.stamp_ns);
  return over > 0 ? (last.sum - first->sum) / over : 0;
}

}  // namespace zonepack
