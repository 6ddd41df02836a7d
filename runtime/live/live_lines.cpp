// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/live_lines.hpp"

#include <algorithm>
#include <atomic>
#include <iostream>
#include <utility>
#include <vector>

#include "platform/base/last_act.hpp"

namespace zonepack {
namespace {

std::atomic<OutputLines*> outputs_of_the_run{nullptr};

void make_outputs_safe() noexcept {
  if (OutputLines* const outputs = outputs_of_the_run.load()) outputs->make_safe();
}

}  // namespace

LiveLines::LiveLines(GpioPort& port, const GpioSettings& gpio)
    : outputs(port, gpio, board), inputs(port, gpio, board) {}

bool LiveLines::open(bool allow_degraded, std::string& fault) {
  std::vector<std::string> warnings;
  if (!outputs.open(allow_degraded, fault, warnings)) return false;
  if (!inputs.open(allow_degraded, fault, warnings)) return false;
  for (const std::string& warning : warnings) {
    std::cerr << "zoned: warning: " + warning + "; it is tried again every second\n";
  }
  outputs_of_the_run.store(&outputs);
  set_last_act(make_outputs_safe);
  return true;
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
