// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "platform/gpio_line.hpp"
#include "runtime/live/input_lines.hpp"
#include "runtime/live/output_lines.hpp"
#include "runtime/run/line_board.hpp"

namespace zonepack {

// All lines of a live run. The outputs go to their safe levels when it stops, when it is destroyed,
// and when an invariant fails (ZP_REQUIRE); other deaths are --safe-outputs' to mend. One at a
// time in a process.   Threads: its owner's.
class LiveLines {
 public:
  LiveLines(GpioPort& port, const GpioSettings& gpio);
  ~LiveLines() { stop(); }

  // False with a complete message in `fault`; what is missing with allow_degraded goes to standard
  // error.
  bool open(bool allow_degraded, std::string& fault);
  Result<void> start(std::function<LiveStatus()> status, std::function<LoadEnd()> last_load,
                     std::int64_t period_ns);
  void stop() noexcept;

  std::uint64_t not_working() const noexcept;

  LineBoard board;
  OutputLines outputs;
  InputLines inputs;
};

}  // namespace zonepack
