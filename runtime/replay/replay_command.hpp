// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "platform/base/byte_count.hpp"
#include "runtime/odometry/pose.hpp"

namespace zonepack {

// Where a run starts: the first fix, the true pose, or a pose that was given.
struct StartChoice {
  enum class Kind : std::uint8_t { kFix, kTruth, kPose };
  Kind kind = Kind::kFix;
  Pose2 pose;
};

// "fix", "truth", or "X,Y,YAW" in metres and degrees; nothing for other texts.
std::optional<StartChoice> parse_start(const std::string& text);

// What `zoned replay` is told; empty paths: not given.
struct ReplayArguments {
  std::string config, map, can, corrections, truth;
  StartChoice start;
  std::optional<ByteCount> budget;              // over the settings
  std::optional<std::uint64_t> max_signatures;  // over the settings
  std::optional<std::uint64_t> storage_rate;    // over the settings
  std::string events, json, report;             // json "-": standard output
  std::string picture;                          // the small picture
  std::string baseline;                         // RTAB-Map's own curve, for both
};

// Reads what the arguments name, replays, and writes results; the summary goes to standard output,
// messages to standard error. Returns the exit code: 0, or 1 when something could not be read, held
// or written, or a limit was exceeded.
int run_replay(const ReplayArguments& arguments);

}  // namespace zonepack
