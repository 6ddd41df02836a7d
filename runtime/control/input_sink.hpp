// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "runtime/control/cycle.hpp"

namespace zonepack {

// Receives the inputs of every cycle, so that the run can be replayed.
// Real-time: on_inputs() neither blocks, allocates nor throws.
// Threads: called by the control thread.
class InputSink {
 public:
  virtual ~InputSink() = default;

  // clock_offset_ns: CLOCK_REALTIME minus the clock of input.now_ns.
  virtual void on_inputs(std::uint64_t cycle, const CycleInput& input,
                         std::int64_t clock_offset_ns) noexcept = 0;

  // Cycles that could not be kept.
  virtual std::uint64_t lost() const noexcept = 0;
};

}  // namespace zonepack
