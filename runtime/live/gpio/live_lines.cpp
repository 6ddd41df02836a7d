// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/gpio/live_lines.hpp"

#include <algorithm>
#include <atomic>
#include <utility>
#include <vector>

#include "platform/base/last_act.hpp"
#include "runtime/live/messages/print_line.hpp"

namespace zonepack {
namespace {

std::atomic<OutputLines*> outputs_of_the_run{nullptr};

void make_outputs_safe() noexcept {
  if (OutputLines* const outputs = outputs_of_the_run.load()) outputs->make_safe();
}

}  // namespace

LiveLines::LiveLines(GpioPort& port, const GpioSettings& gpio)
    : outputs(port, gpio, board), inputs(port, gpio, board) {}

Outcome<void> LiveLines::open(bool allow_degraded) {
  const auto for_outputs = outputs.open(allow_degraded);
  if (!for_outputs) return for_outputs.error();
  const auto for_inputs = inputs.open(allow_degraded);
  if (!for_inputs) return for_inputs.error();
  for (const auto* const warnings : {&*for_outputs, &*for_inputs}) {
    for (const std::string& warning : *warnings) {
      print_line("warning: " + warning + "; it is tried again every second");
    }
  }
  outputs_of_the_run.store(&outputs);
  set_last_act(make_outputs_safe);
  return {};
}

Result<void> LiveLines::start(std::function<LiveStatus()> status,
                              std::function<LoadEnd()> last_load, std::int64_t period_ns) {
  if (const auto started = inputs.start(); !started) return started;
  return outputs.start({std::move(status), std::move(last_load)}, period_ns);
}

void LiveLines::stop() noexcept {
  inputs.stop();
  outputs.stop();
  set_last_act(nullptr);
  outputs_of_the_run.store(nullptr);
}

std::uint64_t LiveLines::not_working() const noexcept {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(board.rows(), [](const LineRow& row) { return !row.working.load(); }));
}

}  // namespace zonepack
