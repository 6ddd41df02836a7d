// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "runtime/protocol/protocol_generated.h"
#include "runtime/run/figures/live_status.hpp"
#include "runtime/serve/answers.hpp"
#include "runtime/serve/served_map.hpp"

namespace zonepack {

// What the numbers of a status are taken from.
struct StatusSource {
  const LiveStatus& live;
  const ServerCounters& server;
  const ServedMap& map;

  std::uint32_t zones() const noexcept { return static_cast<std::uint32_t>(map.zones.size()); }
  bool can_up() const noexcept {
    return live.bus.link == CanLink::kUp && live.bus.state != CanBusState::kOff;
  }
};

// One number of the status: how zoned fills it into its answer, and how zonectl shows it.
struct StatusFigure {
  enum class Kind : std::uint8_t { kCounter, kGauge, kFlag };

  const char* key;     // in JSON
  const char* metric;  // in Prometheus text
  Kind kind;
  const char* help;
  void (*put)(wire::StatusBuilder& to, const StatusSource& from);  // null: part of the pose
  std::string (*text)(const wire::Status& status);  // "12", "0.0015"; flags "0" and "1"
};

// All of them, in the order in which they are shown. The only list: a new counter takes a member
// where it is counted, a field in protocol.fbs, and a row here.
std::span<const StatusFigure> status_figures() noexcept;

// "0.0015": nine significant digits.
std::string decimal_text(double value);

// Standard deviation of the position, metres; 0 when unknown.
double sigma_m_of(const wire::PoseReport* pose) noexcept;

}  // namespace zonepack
