// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/failure.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/run/inputs/command_lines.hpp"
#include "runtime/run/inputs/run_files.hpp"
#include "runtime/run/inputs/run_start.hpp"
#include "runtime/run/maps/map_model.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// What the command lines of `zoned replay` and `zoned run` have in common; empty paths: not given.
struct RunChoices {
  std::string config, map, corrections, truth;
  StartChoice start;
  std::optional<ByteCount> budget;              // over the settings
  std::optional<std::uint64_t> max_signatures;  // over the settings
  std::optional<std::uint64_t> storage_rate;    // over the settings
};

// Everything read from files before a run.
struct RunInputs {
  Settings settings;
  std::string settings_text;  // the file's
  Catalog catalog;
  std::vector<PoseCorrection> corrections;
  std::vector<TimedCommand> commands;  // from the file of corrections
  std::optional<TruthTrack> truth;
  std::shared_ptr<const LearnedTransitions> learned;  // of preload.transitions; null: not given
  std::vector<std::string> warnings;                  // for people
};

// Fails at the first thing that is wrong.
Outcome<RunInputs> read_run_inputs(const RunChoices& choices);

// The most that a map may take when no budget is set: a quarter of this computer's memory.
ByteCount default_budget_limit();

CycleConfig cycle_config(const Settings& settings);
// Whether a run by these settings holds a table of Transitions.
bool has_habits(const Settings& settings);
MapTerms map_terms(const RunChoices& choices, const Settings& settings,
                   std::shared_ptr<const LearnedTransitions> learned);
inline MapTerms map_terms(const RunChoices& choices, const RunInputs& inputs) {
  return map_terms(choices, inputs.settings, inputs.learned);
}

// A file as zoned learn writes it. Failures name it.
Outcome<LearnedTransitions> load_transitions(const std::string& path);

}  // namespace zonepack
