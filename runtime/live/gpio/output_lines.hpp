// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/devices/gpio_line.hpp"
#include "platform/process/realtime.hpp"
#include "runtime/live/gpio/line_requests.hpp"
#include "runtime/run/figures/histogram.hpp"
#include "runtime/run/figures/line_board.hpp"
#include "runtime/run/figures/live_status.hpp"

namespace zonepack {

// The loader's last success, by CLOCK_MONOTONIC.
struct LoadEnd {
  ZoneId zone = kNoZone;
  std::int64_t ns = 0;
};

// Drives map_ready, fault and heartbeat from what the control thread publishes, in a thread of its
// own: a chip behind a slow bus delays this thread and nobody else. One thread for all three, so
// that a heartbeat says that the others are up to date: it stops while they cannot be set, and
// while control cycles do not go on. Then map_ready falls and fault rises, as far as they can be
// reached. Until the first cycle, after stop() and whenever control ended, every line is at its
// safe level.
class OutputLines {
 public:
  // All must outlive this object.
  OutputLines(GpioPort& port, const GpioSettings& gpio, LineBoard& board);
  ~OutputLines() { stop(); }

  // Opens the lines at their safe levels. Fails at the first that cannot be opened; with
  // allow_degraded such lines are returned as complete warnings and tried again every second.
  Outcome<std::vector<std::string>> open(bool allow_degraded);

  struct Sources {
    std::function<LiveStatus()> status;
    std::function<LoadEnd()> last_load;
  };
  // period_ns: of control cycles, by CLOCK_MONOTONIC.
  Result<void> start(Sources sources, std::int64_t period_ns);
  void stop() noexcept;

  // From any thread, also one that is about to end the process: the safe levels, for good. Waits
  // for a turn under way, but not for ever.
  void make_safe() noexcept;

  // What the thread does every two milliseconds, for tests without it.
  void turn(const LiveStatus& status, const LoadEnd& load, std::int64_t now_ns) noexcept;
  void set_period(std::int64_t period_ns) noexcept;

  // From the end of a load to the line, of loads that map_ready waited for. After stop().
  const Histogram& ready_latency() const noexcept { return latency_; }

 private:
  struct Line {
    OutputRequest request;
    LineRow* row;
    std::unique_ptr<GpioOutput> line;
    bool active = false;
    std::int64_t retry_ns = 0;
  };

  void run();
  void follow(const LiveStatus& status, const LoadEnd& load, std::int64_t now_ns) noexcept;
  Line* find(OutputKind kind) noexcept;
  bool put(Line& line, bool active, std::int64_t now_ns) noexcept;
  void begin(Line& line) noexcept;
  bool reopen(Line& line, std::int64_t now_ns) noexcept;
  void follow_latency(const LiveStatus& status, const LoadEnd& load, bool ready,
                      std::int64_t now_ns) noexcept;

  GpioPort& port_;
  LineBoard& board_;
  std::int64_t half_wave_ns_;
  std::int64_t stuck_ns_ = 0;
  std::vector<Line> lines_;
  Sources sources_;
  std::uint64_t cycles_ = 0;
  std::int64_t moved_ns_ = 0;
  std::int64_t toggled_ns_ = 0;
  std::uint64_t toggled_at_ = 0;  // cycle
  bool ready_ = false;
  bool trusted_ = false;
  std::int64_t waiting_since_ns_ = 0;  // for a load alone: not ready, the pose trusted
  Histogram latency_;
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;  // a turn, or make_safe()
  std::atomic<bool> safe_{false};
  std::atomic<bool> stop_{false};
  Thread thread_;
};

}  // namespace zonepack
