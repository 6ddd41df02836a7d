// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/run/map_model.hpp"
#include "runtime/run/run_files.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// Where a run starts: the first fix, the true pose, or a pose that was given.
struct StartChoice {
  enum class Kind : std::uint8_t { kFix, kTruth, kPose };
  Kind kind = Kind::kFix;
  Pose2 pose;
};

// "fix", "truth", or "X,Y,YAW" in metres and degrees; nothing for other texts.
std::optional<StartChoice> parse_start(const std::string& text);

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
  std::optional<TruthTrack> truth;
};

// A complete message for the first thing that is wrong, or nothing.
std::optional<std::string> read_run_inputs(const RunChoices& choices, RunInputs& inputs);

CycleConfig cycle_config(const Settings& settings);
MapTerms map_terms(const RunChoices& choices, const Settings& settings);

// Where the robot truly is at the start; truth may begin a little after the bus.
std::optional<Pose2> first_truth(const TruthTrack* truth, std::int64_t start_ns);

}  // namespace zonepack
