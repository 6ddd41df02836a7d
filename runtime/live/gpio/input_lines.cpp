// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/gpio/input_lines.hpp"

#include <array>
#include <utility>

#include "platform/base/require.hpp"
#include "platform/process/clock.hpp"
#include "runtime/live/gpio/line_opening.hpp"

namespace zonepack {
namespace {

constexpr std::int64_t kLook_ns = 2'000'000;
constexpr std::size_t kQueued = 256;

}  // namespace

InputLines::InputLines(GpioPort& port, const GpioSettings& gpio, LineBoard& board)
    : edges(kQueued), port_(port) {
  for (InputRequest& request : input_requests(gpio)) {
    LineRow& row = board.add(request.name, false);
    lines_.push_back({std::move(request), &row, nullptr});
  }
}

Outcome<std::vector<std::string>> InputLines::open(bool allow_degraded) {
  return open_lines(port_, lines_, allow_degraded);
}

Result<void> InputLines::start() {
  if (lines_.empty()) return {};
  auto thread = Thread::start({.name = "zoned-inputs"}, true, [this] { run(); });
  if (!thread) return thread.error();
  thread_ = std::move(thread).value();
  return {};
}

void InputLines::stop() noexcept {
  stop_.store(true);
  thread_.join();
}

void InputLines::run() {
  while (!stop_.load()) {
    turn(monotonic_ns());
    sleep_until_ns(monotonic_ns() + kLook_ns);
  }
}

void InputLines::turn(std::int64_t now_ns) noexcept {
  std::array<GpioEdge, kAtOnce> taken;
  for (Line& line : lines_) {
    // One more for the edge that a failure makes.
    if (edges.free_space() <= kAtOnce) return;
    if (!line.line && !reopen_line(port_, line, now_ns)) continue;
    const auto count = line.line->take(taken);
    if (!count) {
      fail(line, now_ns);
      continue;
    }
    for (std::size_t i = 0; i < *count; ++i) tell(line, taken[i]);
  }
}

void InputLines::tell(Line& line, const GpioEdge& edge) noexcept {
  const bool queued = edges.push({edge.stamp_ns, line.request.line, edge.active});
  ZP_REQUIRE(queued);
  line.row->active.store(edge.active);
  line.row->changes.fetch_add(1);
}

void InputLines::fail(Line& line, std::int64_t now_ns) noexcept {
  line.row->failures.fetch_add(1);
  line.row->working.store(false);
  line.line.reset();
  line.retry_ns = now_ns + kTryLineAgain_ns;
  if (line.row->active.load()) tell(line, {now_ns, false});
}

}  // namespace zonepack
