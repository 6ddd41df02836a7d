// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "platform/can/can_bus.hpp"

namespace zonepack {

// A sequence of frames: a log, a list, a generator.
class CanFrameSource {
 public:
  virtual ~CanFrameSource() = default;
  virtual std::optional<CanFrame> next() noexcept = 0;
  // Frames known to be missing before the one that next() returned last.
  virtual std::uint64_t dropped() const noexcept { return 0; }
};

}  // namespace zonepack
