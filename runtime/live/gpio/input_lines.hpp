// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/devices/gpio_line.hpp"
#include "platform/memory/spsc_queue.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/control/line_edge.hpp"
#include "runtime/live/gpio/line_requests.hpp"
#include "runtime/run/figures/line_board.hpp"

namespace zonepack {

// Reads the robot's input lines in a thread of its own, and hands their edges to the control
// thread. An edge for which the queue has no room stays at its line until there is some. A line
// that fails counts as inactive, and is opened again once it can be.
class InputLines {
 public:
  // All must outlive this object.
  InputLines(GpioPort& port, const GpioSettings& gpio, LineBoard& board);
  ~InputLines() { stop(); }

  // As of OutputLines.
  Outcome<std::vector<std::string>> open(bool allow_degraded);
  Result<void> start();
  void stop() noexcept;

  // What the thread does every two milliseconds, for tests without it.
  void turn(std::int64_t now_ns) noexcept;

  SpscQueue<LineEdge> edges;  // to the control thread; stamps by CLOCK_MONOTONIC

 private:
  static constexpr std::size_t kAtOnce = 8;

  struct Line {
    InputRequest request;
    LineRow* row;
    std::unique_ptr<GpioInput> line;
    std::int64_t retry_ns = 0;
  };

  void run();
  void tell(Line& line, const GpioEdge& edge) noexcept;
  void fail(Line& line, std::int64_t now_ns) noexcept;

  GpioPort& port_;
  std::vector<Line> lines_;
  std::atomic<bool> stop_{false};
  Thread thread_;
};

}  // namespace zonepack
