// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "platform/devices/gpio_line.hpp"

namespace zonepack {

// Debounces a line: a level counts once it has lasted the debounce time, from the edge that began
// it. Only the stamps of the edges decide, so the result does not depend on how late they are read.
// Begins inactive.
//
// Real-time: O(1), no allocation.
class EdgeFilter {
 public:
  explicit EdgeFilter(std::int64_t debounce_ns) noexcept : debounce_ns_(debounce_ns) {}

  // Takes a raw change of the line, or its first level. A stamp earlier than the one before counts
  // as that one. Returns the edge that this change settles: the level that ends here had lasted
  // long enough, or the debounce time is 0.
  std::optional<GpioEdge> change(const GpioEdge& raw) noexcept;

  // The edge that has settled by now, if any.
  std::optional<GpioEdge> settle(std::int64_t now_ns) noexcept;

  bool level() const noexcept { return level_; }  // the newest, settled or not

 private:
  std::int64_t debounce_ns_;
  std::int64_t since_ns_ = INT64_MIN;
  bool level_ = false;
  bool settled_ = false;
};

}  // namespace zonepack
