// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/can/can_bus.hpp"
#include "platform/can/can_log.hpp"
#include "runtime/live/bus/can_source.hpp"
#include "runtime/live/cycle/control_loop.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/settings/settings.hpp"

namespace zonepack {

// What a source needs to know of its run; all of it outlives the source.
struct LiveSourceTerms {
  CanSourceChoice choice;
  const Settings& settings;
  std::vector<PoseCorrection> corrections;  // of a log; a robot's come from other programs
  std::int64_t period_ns = 0;
  const SpscQueue<LiveNote>& notes;
  bool allow_degraded = false;  // an interface that is not there is waited for
};

// Where frames and time come from: a bus of the robot, or a log that is played.
class LiveSource {
 public:
  virtual ~LiveSource() = default;

  static Outcome<std::unique_ptr<LiveSource>> open(LiveSourceTerms terms);

  virtual RunClock& clock() noexcept = 0;
  virtual CanBus& bus() noexcept = 0;
  virtual SpscQueue<PoseCorrection>& corrections() noexcept = 0;
  virtual std::int64_t start_ns() const noexcept = 0;  // no cycle's time lies before
  virtual bool robot() const noexcept = 0;             // cannot wait, repeat or hurry
  virtual std::string interface() const = 0;           // whose frames they are, as in a log
  virtual void stop() noexcept {}
  virtual void ask_stop() noexcept {}                 // as stop(), without waiting for a thread
  virtual std::string warning() const { return {}; }  // what works, but not as it should
  virtual const CanLogSummary* log_summary() const noexcept { return nullptr; }
};

// The ids whose frames odometry reads, heartbeats and SYNC of CANopen among them; each once.
std::vector<CanId> odometry_ids(const WheelOdometrySettings& odometry);

}  // namespace zonepack
