// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/control/cycle.hpp"
#include "runtime/odometry/pose_filter.hpp"
#include "runtime/replay/resident_zones.hpp"
#include "runtime/run/inputs/command_lines.hpp"

namespace zonepack {

// What a localizer finds after a cycle.
struct FixMoment {
  std::int64_t now_ns = 0;  // the cycle's
  const CycleState& state;
  const ResidentZones& resident;
};

// Gives a replay fixes that depend on what it did so far: the loop from pose to zones to pose.
class FixSource {
 public:
  virtual ~FixSource() = default;

  // Adds fixes. Each has a received_ns after moment.now_ns and enters at the first cycle that is
  // not before it, after those that were added earlier for the same time: a file of the same fixes
  // gives the same run.
  virtual void after_cycle(const FixMoment& moment, std::vector<PoseCorrection>& fixes) = 0;

  // Called after that: adds what it commands, in the same way.
  virtual void command(const FixMoment& /*moment*/, std::vector<TimedCommand>& /*commands*/) {}
};

}  // namespace zonepack
