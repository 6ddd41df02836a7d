// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/can/can_frame_source.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/replay/fix_source.hpp"
#include "runtime/run/figures/run_summary.hpp"
#include "runtime/run/figures/run_trace.hpp"
#include "runtime/run/inputs/command_lines.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/run/inputs/run_start.hpp"
#include "runtime/run/maps/map_model.hpp"
#include "runtime/run/run.hpp"

namespace zonepack {

// A CAN log with what came with it, and the limits to hold while driving it again.
struct ReplayInput {
  const Catalog& catalog;
  CanFrameSource& frames;
  std::vector<PoseCorrection> corrections{};  // in order of reception
  std::vector<TimedCommand> commands{};       // of a localizer, in order of reception
  const TruthTrack* truth = nullptr;          // for the figures, and for a start at the truth
  StartChoice start{};
  CycleConfig cycle{};
  std::uint32_t most_frames = 64;  // taken from the bus in one cycle
  MapTerms terms{};
  std::string events_path{};        // empty: none
  bool load_packs = true;           // false: zones are accounted for, no pack is read
  FixSource* fixes = nullptr;       // computes corrections while it runs
  RunObserver* observer = nullptr;  // watches
  EvictionOrderMaker eviction{};    // nothing: least recently used
  bool keep_trace = true;           // false: the result has none
};

struct ReplayResult {
  RunSummary summary;
  RunTrace trace;
  Outcome<void> events_written;       // the event log's file
  std::vector<std::string> faults;    // complete messages: zones that could not be loaded
  std::vector<std::string> warnings;  // complete messages
};

// Drives the log through a run, in simulated time: a cycle every period_ns from the first frame to
// the last; frames enter at their stamp, corrections when received, loads when the model says.
// Nothing is measured: the same input gives the same result everywhere.
Outcome<ReplayResult> replay(ReplayInput input);

}  // namespace zonepack
