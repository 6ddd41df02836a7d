// SPDX-License-Identifier: Apache-2.0
#include "platform/devices/edge_filter.hpp"

#include <algorithm>

namespace zonepack {

std::optional<GpioEdge> EdgeFilter::change(const GpioEdge& raw) noexcept {
  const std::int64_t stamp_ns = std::max(raw.stamp_ns, since_ns_);
  std::optional<GpioEdge> ended = settle(stamp_ns);
  if (raw.active != level_) {
    level_ = raw.active;
    since_ns_ = stamp_ns;
  }
  return ended ? ended : settle(stamp_ns);
}

std::optional<GpioEdge> EdgeFilter::settle(std::int64_t now_ns) noexcept {
  if (level_ == settled_ || now_ns - since_ns_ < debounce_ns_) return std::nullopt;
  settled_ = level_;
  return GpioEdge{since_ns_, level_};
}

}  // namespace zonepack
