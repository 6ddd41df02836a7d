// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/process/clock.hpp"
#include "runtime/live/cycle/control_loop.hpp"

namespace zonepack {

// The time of a robot that drives: CLOCK_MONOTONIC at the beginning of each cycle, until stopped.
class RobotClock final : public RunClock {
 public:
  std::int64_t cycle_time_ns(std::uint64_t, std::int64_t began_ns) noexcept override {
    return began_ns;
  }
  bool await_inputs(std::uint64_t) noexcept override { return true; }
  bool more() noexcept override { return true; }
  std::int64_t offset_ns() noexcept override { return clock_offset_ns(); }
};

}  // namespace zonepack
