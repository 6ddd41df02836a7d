// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/devices/gpio_line.hpp"
#include "runtime/settings/gpio_settings.hpp"

namespace zonepack {

enum class OutputKind : std::uint8_t { kMapReady, kFault, kHeartbeat };

// The lines of the settings, as a GpioPort is asked for them.
struct OutputRequest {
  std::string name;  // "map_ready"
  OutputKind kind = OutputKind::kMapReady;
  GpioOutputSettings settings;  // at its safe level
};
struct InputRequest {
  std::string name;        // "dock", "zone_markers.door"
  std::uint32_t line = 0;  // LineEdge's
  GpioInputSettings settings;
};
std::vector<OutputRequest> output_requests(const GpioSettings& gpio);
std::vector<InputRequest> input_requests(const GpioSettings& gpio);

// The lines as they are found, without opening them: "map_ready", and "gpiochip0 (robot), line 2,
// free", or the message of what is wrong.
struct LineFinding {
  std::string name;
  std::string found, fault;
};
std::vector<LineFinding> inspect_lines(GpioPort& port, const GpioSettings& gpio);

// Sets every output to its safe level and gives it back. Complete messages for those that could not
// be set; the others are.
std::vector<std::string> set_safe_outputs(GpioPort& port, const GpioSettings& gpio);

// "gpio.dock: line 5 of chip robot: ..."
std::string line_fault(GpioPort& port, const std::string& name, const GpioLineName& line,
                       const Error& error);

}  // namespace zonepack
