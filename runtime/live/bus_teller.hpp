// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "platform/can_bus.hpp"

namespace zonepack {

// Puts changes of a bus into words for a log.
class BusTeller {
 public:
  explicit BusTeller(std::string interface) : interface_(std::move(interface)) {}

  // A line when link or state changed or frames were lost since the last call.
  std::optional<std::string> tell(const CanBusStatus& status);

 private:
  std::string interface_;
  CanBusStatus told_;
};

}  // namespace zonepack
