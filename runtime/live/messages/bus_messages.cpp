// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/messages/bus_messages.hpp"

namespace zonepack {
namespace {

std::string link_text(CanLink link) {
  switch (link) {
    case CanLink::kUp:
      return "up";
    case CanLink::kNoCarrier:
      return "the controller is off the bus; no odometry until it is started again";
    case CanLink::kDown:
      return "down; no odometry until it is up again";
    case CanLink::kAbsent:
      return "no such interface; no odometry until there is one";
  }
  return "unknown";
}

std::string state_text(CanBusState state) {
  switch (state) {
    case CanBusState::kActive:
      return "the controller is error active";
    case CanBusState::kWarning:
      return "the controller warns of many errors on the bus; check wiring, termination, bit rate";
    case CanBusState::kPassive:
      return "the controller is error passive; check wiring, termination, bit rate";
    case CanBusState::kOff:
      return "bus-off; with restart-ms set (ip link set ... type can restart-ms 100) it comes back "
             "by itself";
  }
  return "unknown";
}

}  // namespace

std::optional<std::string> BusMessages::next(const CanBusStatus& status) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (status.link != told_.link) add(link_text(status.link));
  if (status.reconnects != told_.reconnects) add("opened again");
  if (status.state != told_.state) add(state_text(status.state));
  if (status.restarts != told_.restarts) add("restarted after a bus-off");
  if (status.dropped != told_.dropped) {
    add(std::to_string(status.dropped - told_.dropped) + " frames lost before they were read");
  }
  if (status.overflows != told_.overflows) add("the controller lost frames");
  told_ = status;
  if (text.empty()) return std::nullopt;
  return interface_ + ": " + text;
}

}  // namespace zonepack
