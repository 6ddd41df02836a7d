// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/gpio/output_lines.hpp"

#include <algorithm>
#include <utility>

#include "platform/process/clock.hpp"
#include "runtime/live/gpio/line_opening.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kSetEvery_ns = 2'000'000;
constexpr std::int64_t kLeastStuck_ns = 100'000'000;
constexpr int kStuckPeriods = 10;
constexpr int kMostWait_ms = 1000;  // of make_safe(), for a set under way

bool is_fault(const LiveStatus& status) noexcept {
  const CycleState& state = status.state;
  const bool outran_its_map = state.pose.trusted && state.zone != kNoZone && !state.zone_resident;
  return state.odometry_stale || state.blocked || outran_its_map;
}

}  // namespace

OutputLines::OutputLines(GpioPort& port, const GpioSettings& gpio, LineBoard& board)
    : port_(port),
      board_(board),
      half_wave_ns_(static_cast<std::int64_t>(gpio.heartbeat_s * 1e9 / 2)) {
  for (OutputRequest& request : output_requests(gpio)) {
    LineRow& row = board.add(request.name, true);
    lines_.push_back({std::move(request), &row, nullptr});
  }
}

Outcome<std::vector<std::string>> OutputLines::open(bool allow_degraded) {
  auto warnings = open_lines(port_, lines_, allow_degraded);
  if (!warnings) return warnings;
  for (Line& line : lines_) begin(line);
  return warnings;
}

void OutputLines::set_period(std::int64_t period_ns) noexcept {
  stuck_ns_ = std::max(kLeastStuck_ns, kStuckPeriods * period_ns);
}

Result<void> OutputLines::start(Sources sources, std::int64_t period_ns) {
  if (lines_.empty()) return {};
  sources_ = std::move(sources);
  set_period(period_ns);
  moved_ns_ = monotonic_ns();
  auto thread = Thread::start({.name = "zoned-lines"}, true, [this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void OutputLines::run() {
  while (!stop_.load()) {
    turn(sources_.status(), sources_.last_load(), monotonic_ns());
    sleep_until_ns(monotonic_ns() + kSetEvery_ns);
  }
}

void OutputLines::stop() noexcept {
  stop_.store(true);
  thread_.join();
  make_safe();
}

void OutputLines::make_safe() noexcept {
  safe_.store(true);
  for (int ms = 0; ms < kMostWait_ms && busy_.test_and_set(); ++ms) {
    sleep_until_ns(monotonic_ns() + 1'000'000);
  }
  for (Line& line : lines_) {
    if (line.line) static_cast<void>(line.line->set(line.request.settings.active));
  }
  busy_.clear();
}

OutputLines::Line* OutputLines::find(OutputKind kind) noexcept {
  const auto found = std::find_if(lines_.begin(), lines_.end(),
                                  [kind](const Line& line) { return line.request.kind == kind; });
  return found == lines_.end() ? nullptr : &*found;
}

void OutputLines::turn(const LiveStatus& status, const LoadEnd& load,
                       std::int64_t now_ns) noexcept {
  if (busy_.test_and_set()) return;
  if (!safe_.load()) follow(status, load, now_ns);
  busy_.clear();
}

void OutputLines::follow(const LiveStatus& status, const LoadEnd& load,
                         std::int64_t now_ns) noexcept {
  if (status.state.cycles != cycles_) {
    cycles_ = status.state.cycles;
    moved_ns_ = now_ns;
  }
  if (cycles_ == 0) return;
  const bool stuck = now_ns - moved_ns_ > stuck_ns_;
  const bool ready = status.state.map_ready && !stuck;
  const auto tell = [this, now_ns](OutputKind kind, bool active) {
    Line* const line = find(kind);
    return line == nullptr || put(*line, active, now_ns);
  };
  // map_ready falls first and rises last: nobody sees it high together with a fault.
  bool told = ready || tell(OutputKind::kMapReady, false);
  const bool fault_told = tell(OutputKind::kFault, stuck || is_fault(status));
  if (ready) told = tell(OutputKind::kMapReady, true);
  if (told) follow_latency(status, load, ready, now_ns);
  told = told && fault_told;
  Line* const heartbeat = find(OutputKind::kHeartbeat);
  if (heartbeat == nullptr || !told || cycles_ == toggled_at_ ||
      now_ns - toggled_ns_ < half_wave_ns_) {
    return;
  }
  if (!put(*heartbeat, !heartbeat->active, now_ns)) return;
  toggled_ns_ = now_ns;
  toggled_at_ = cycles_;
}

bool OutputLines::put(Line& line, bool active, std::int64_t now_ns) noexcept {
  if (!line.line && !reopen(line, now_ns)) return false;
  if (line.active == active && line.row->working.load()) return true;
  if (safe_.load()) return false;
  const auto done = line.line->set(active);
  line.row->working.store(done.ok());
  if (!done) {
    line.row->failures.fetch_add(1);
    line.line.reset();
    line.retry_ns = now_ns + kTryLineAgain_ns;
    return false;
  }
  line.row->changes.fetch_add(line.active != active ? 1 : 0);
  line.active = active;
  line.row->active.store(active);
  return true;
}

// As it was asked to be when it is opened.
void OutputLines::begin(Line& line) noexcept {
  line.active = line.line != nullptr && line.request.settings.active;
  line.row->active.store(line.active);
}

bool OutputLines::reopen(Line& line, std::int64_t now_ns) noexcept {
  if (!reopen_line(port_, line, now_ns)) return false;
  begin(line);
  return true;
}

void OutputLines::follow_latency(const LiveStatus& status, const LoadEnd& load, bool ready,
                                 std::int64_t now_ns) noexcept {
  const bool trusted = status.state.pose.trusted;
  const bool rises = ready && !ready_;
  if (rises && trusted_ && load.zone == status.state.zone && load.ns >= waiting_since_ns_) {
    latency_.add(std::max<std::int64_t>(0, monotonic_ns() - load.ns));
    board_.ready_latency.store(latency_.figures());
  }
  if ((ready_ && !ready) || (trusted && !trusted_)) waiting_since_ns_ = now_ns;
  ready_ = ready;
  trusted_ = trusted;
}

}  // namespace zonepack
