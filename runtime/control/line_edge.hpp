// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace zonepack {

// A change of an input line, as the control thread takes it and recordings hold it.
struct LineEdge {
  static constexpr std::uint32_t kDock = 0;         // a contact at a known pose
  static constexpr std::uint32_t kHold = 1;         // freezes eviction
  static constexpr std::uint32_t kFirstMarker = 2;  // from here on zone markers, in their order
  static constexpr std::size_t kMostMarkers = 32;

  std::int64_t stamp_ns = 0;  // the run's clock
  std::uint32_t line = 0;
  bool active = false;
};

}  // namespace zonepack
