// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "platform/base/failure.hpp"
#include "platform/devices/gpio_line.hpp"
#include "runtime/live/gpio/input_lines.hpp"
#include "runtime/live/gpio/output_lines.hpp"
#include "runtime/run/figures/line_board.hpp"

namespace zonepack {

// All GPIO lines of a live run. The outputs go to their safe levels when it stops, when it is
// destroyed, and when an invariant fails (ZP_REQUIRE); after other deaths, zoned --safe-outputs
// sets them. One at a time in a process.
//
// Threads: its owner's.
class LiveLines {
 public:
  LiveLines(GpioPort& port, const GpioSettings& gpio);
  ~LiveLines() { stop(); }

  // Fails at the first line that cannot be opened; with allow_degraded such lines are warnings on
  // standard error.
  Outcome<void> open(bool allow_degraded);
  Result<void> start(std::function<LiveStatus()> status, std::function<LoadEnd()> last_load,
                     std::int64_t period_ns);
  void stop() noexcept;

  std::uint64_t not_working() const noexcept;

  LineBoard board;
  OutputLines outputs;
  InputLines inputs;
};

}  // namespace zonepack
