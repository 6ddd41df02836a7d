// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "platform/can/can_bus.hpp"

namespace zonepack {

// Puts changes of a bus into words for a log.
class BusMessages {
 public:
  explicit BusMessages(std::string interface) : interface_(std::move(interface)) {}

  // A line when link or state changed or frames were lost since the last call.
  std::optional<std::string> next(const CanBusStatus& status);

 private:
  std::string interface_;
  CanBusStatus told_;
};

}  // namespace zonepack
