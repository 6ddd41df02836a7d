// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "platform/base/failure.hpp"
#include "runtime/control/cycle.hpp"
#include "runtime/odometry/pose.hpp"
#include "runtime/run/inputs/run_files.hpp"

namespace zonepack {

// Where the user says that a run starts: at the first fix, at the true pose, or at a given pose.
struct StartChoice {
  enum class Kind : std::uint8_t { kFix, kTruth, kPose };
  Kind kind = Kind::kFix;
  Pose2 pose;
};

// "X,Y,YAW_DEG": metres within a thousand kilometres of the origin, degrees of at most a million
// radians, which are wrapped; nothing for another text.
std::optional<Pose2> parse_pose(std::string_view text);

// "fix", "truth", or "X,Y,YAW" in metres and degrees; nothing for other texts.
std::optional<StartChoice> parse_start(const std::string& text);

// A guess that the cycle starts from, given before its first run().
struct RunStart {
  std::int64_t now_ns = 0;
  Pose2 T_map_base;
  std::optional<double> sigma_m{}, sigma_rad{};  // both or none: as the settings say
};

// The start that was chosen for a run whose first cycle is at start_ns; nothing to wait for the
// first fix. Fails when the true pose is asked for and the truth, which may be null, does not cover
// the start.
Outcome<std::optional<RunStart>> find_start(const StartChoice& choice, const TruthTrack* truth,
                                            std::int64_t start_ns);

void start_at(Cycle& cycle, const RunStart& start);

}  // namespace zonepack
