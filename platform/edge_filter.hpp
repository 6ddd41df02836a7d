// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "platform/gpio_line.hpp"

namespace zonepack {

// Takes the bouncing out of a line's changes: a level counts once it has lasted the debounce time,
// from the edge that began it. Decided by the edges' own stamps, so it is the same however late
// they are read. Begins inactive. Real-time: O(1), no memory.
class EdgeFilter {
 public:
  explicit EdgeFilter(std::int64_t debounce_ns) noexcept : debounce_ns_(debounce_ns) {}

  // The line changed, or was found, to be so. Stamps that fall count as the one before. Returns the
  // edge that is settled thereby: the level that ends here had lasted, or needs not to last.
  std::optional<GpioEdge> change(const GpioEdge& raw) noexcept;

  // The edge that is settled by now, if there is one.
  std::optional<GpioEdge> settle(std::int64_t now_ns) noexcept;

  bool level() const noexcept { return level_; }  // the newest told, settled or not

 private:
  std::int64_t debounce_ns_;
  std::int64_t since_ns_ = INT64_MIN;
  bool level_ = false;
  bool settled_ = false;
};

}  // namespace zonepack
