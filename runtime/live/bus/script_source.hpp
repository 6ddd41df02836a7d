// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "platform/can/can_log.hpp"
#include "platform/sim/sim_wire.hpp"
#include "runtime/live/bus/can_script.hpp"
#include "runtime/odometry/wheel_odometry.hpp"

namespace zonepack {

// A log that is played several times over, each time a little after the last frame.
class RepeatedLog final : public CanFrameSource {
 public:
  RepeatedLog(std::string path, std::string interface, std::uint32_t loops);

  Outcome<void> open();
  std::optional<CanFrame> next() noexcept override;
  std::uint64_t dropped() const noexcept override;
  const CanLogSummary& summary() const noexcept { return log_->summary(); }  // of this turn

 private:
  std::string path_, interface_;
  std::uint32_t turns_left_;
  std::unique_ptr<CanLogReader> log_;
  std::int64_t shift_ns_ = 0;
  std::optional<std::int64_t> first_ns_;
  std::int64_t last_ns_ = 0;
  std::uint64_t dropped_before_ = 0;
};

// The nodes and the wire of a script, ready to send.
class ScriptedBus {
 public:
  static Outcome<std::unique_ptr<ScriptedBus>> make(const CanScript& script,
                                                    const std::string& interface,
                                                    const WheelOdometrySettings& odometry);

  SimWire& wire() noexcept { return *wire_; }
  // Before the first frame is read from the bus, which must hear this wire.
  void prepare(SimCanBus& bus) const;

 private:
  std::vector<std::unique_ptr<CanFrameSource>> nodes_;
  std::unique_ptr<SimWire> wire_;
  std::size_t queue_ = 0;
};

}  // namespace zonepack
