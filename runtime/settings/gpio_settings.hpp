// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/devices/gpio_line.hpp"

namespace zonepack {

// The level of an output while no zoned drives it.
enum class SafeLevel : std::uint8_t { kUsual, kActive, kInactive };

struct OutputLine {
  std::string chip, line;
  bool active_low = false;
  SafeLevel safe = SafeLevel::kUsual;
};

struct InputLine {
  std::string chip, line;
  bool active_low = false;
  GpioBias bias = GpioBias::kAsIs;
  double debounce_s = 0.02;
};

struct DockPlace {
  double x_m = 1e9, y_m = 1e9, yaw_rad = 1e9;  // of base_link in the map; must be given
  double sigma_m = 0.02, sigma_rad = 0.02;
};

struct MarkerPlace {
  std::vector<std::string> zones;  // two that a portal joins, or one
  double reach_m = 1;
};

// The robot's lines; none unless given.
struct GpioSettings {
  struct Dock {
    InputLine input;
    DockPlace place;
  };
  struct Marker {
    std::string name;
    InputLine input;
    MarkerPlace place;
  };
  double heartbeat_s = 0.1;
  std::optional<OutputLine> map_ready, fault, heartbeat;
  std::optional<Dock> dock;
  std::optional<InputLine> hold;
  std::vector<Marker> markers;

  bool any() const noexcept {
    return map_ready || fault || heartbeat || dock || hold || !markers.empty();
  }
};

}  // namespace zonepack
