// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/can/can_bus.hpp"
#include "platform/can/can_log.hpp"
#include "runtime/control/command.hpp"
#include "runtime/control/line_edge.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/run/figures/baseline.hpp"
#include "runtime/run/inputs/command_lines.hpp"
#include "runtime/run/inputs/log_time.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/run/inputs/run_start.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// The files of a drive as the command line names them; empty: not given.
struct DriveFiles {
  std::string can, corrections, truth, baseline;
  std::string recording;  // instead of all but `baseline`
  const std::string& name() const noexcept { return can.empty() ? recording : can; }
};

// The inputs of a drive, read once for all runs.
//
// Threads: any, once read.
struct Drive {
  DriveFiles files;
  std::vector<CanFrame> frames;
  std::vector<PoseCorrection> corrections;
  std::optional<TruthTrack> truth;
  std::vector<BaselineRow> baseline;  // what RTAB-Map did on it
  CanLogSummary log;                  // what was wrong with a log
  LogTime time;                       // of a log

  // Of a recording: its cycles, each with what came since the one before. Loads and offers of maps
  // are not among it.
  struct Cycle {
    std::int64_t now_ns = 0;
    std::size_t frames = 0, corrections = 0, commands = 0, edges = 0;  // ends in the lists
  };
  struct NamedCommand {
    Command command;
    std::string zone;                // of command.zone; empty: none
    std::vector<std::string> route;  // of command.route
  };
  std::vector<Cycle> cycles;
  std::vector<NamedCommand> commands;
  std::vector<LineEdge> edges;
  std::optional<RunStart> start;

  bool recorded() const noexcept { return !files.recording.empty(); }
};

// Messages for people go to `warnings`.
Outcome<Drive> read_drive(const DriveFiles& files, const Settings& settings,
                          std::vector<std::string>& warnings);

// The commands of a log's file of corrections, with the zones of this map.
Outcome<std::vector<TimedCommand>> commands_on(const Drive& drive, const Catalog& catalog);

// A recorded command with the zones of this map; nothing where it is about a zone that the map does
// not have, or about a reader's lease.
std::optional<Command> on_map(const Drive::NamedCommand& recorded, const Catalog& catalog);

}  // namespace zonepack
