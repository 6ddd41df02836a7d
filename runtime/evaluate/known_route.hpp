// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/run/inputs/command_lines.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {

// The zones of a run, for giving them to another run of the same drive as its route.
class ZonesEntered final : public RunObserver {
 public:
  void on_event(const Event& event, const MapVersion& /*map*/) noexcept override { note(event); }
  void note(const Event& event) noexcept;
  // Since the start of the run, and the zone.
  const std::vector<std::pair<std::int64_t, ZoneId>>& all() const noexcept { return all_; }

 private:
  std::vector<std::pair<std::int64_t, ZoneId>> all_;
};

// Hints for a robot that knows its way: from the start on the first Command::kMostRoute zones, and
// after every half of these the next ones. start_ns: when the run starts, on the clock of its
// fixes.
std::vector<TimedCommand> hints_of(const ZonesEntered& zones, std::int64_t start_ns);

}  // namespace zonepack
