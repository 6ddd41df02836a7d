// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/control/cycle.hpp"
#include "runtime/run/map_model.hpp"
#include "runtime/run/run_summary.hpp"
#include "runtime/run/run_trace.hpp"

namespace zonepack {

// Fills the zones, portals and limits of a trace whose samples are there.
void describe_map(const MapModel& map, RunTrace& trace);

// Fills what the cycle itself counts.
void summarise_cycle(const Cycle& cycle, RunSummary& summary);

}  // namespace zonepack
