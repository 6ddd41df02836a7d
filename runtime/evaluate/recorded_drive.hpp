// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "platform/base/failure.hpp"
#include "runtime/evaluate/drives.hpp"
#include "runtime/replay/replay.hpp"

namespace zonepack {

struct CyclesInput {
  const Catalog& catalog;
  CycleConfig cycle;
  MapTerms terms;
  RunObserver& observer;
  EvictionOrderMaker eviction{};
  bool keep_trace = false;
  bool takes_route = true;  // false: hints of a route are left out
};

// Drives the cycles of a recording, on any map and with any settings: what arrived arrives in the
// same cycles, and loads take the time of the model.
Outcome<ReplayResult> replay_cycles(const Drive& drive, const CyclesInput& input);

}  // namespace zonepack
