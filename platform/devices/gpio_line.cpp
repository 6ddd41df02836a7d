// SPDX-License-Identifier: Apache-2.0
#include "platform/devices/gpio_line.hpp"

#include <cerrno>
#include <cstring>

namespace zonepack {

std::string explain_gpio(GpioPort& port, const GpioLineName& name, const Error& error) {
  const std::string line = "line " + name.line + " of chip " + name.chip;
  switch (error.code) {
    case ErrorCode::kNotFound:
      if (error.detail == GpioPort::kNoLine) {
        return line + ": the chip has no such line; gpioinfo lists numbers and names";
      }
      return "chip " + name.chip +
             ": not found; gpiodetect lists names and labels (is its driver loaded, and may this "
             "user open /dev/gpiochip*?)";
    case ErrorCode::kExists:
      return "chip " + name.chip +
             ": several have this label; name one by its device file, /dev/gpiochip0";
    case ErrorCode::kBusy: {
      const auto info = port.look(name);
      const std::string who = info && !info->consumer.empty() ? info->consumer : "another program";
      return line + ": held by " + who + "; end it, or choose another line";
    }
    case ErrorCode::kMismatch:
      return line +
             ": set up as an output where an input is expected; choose another line, or make it an "
             "input: gpioget CHIP LINE";
    case ErrorCode::kIo: {
      const auto number = static_cast<int>(error.detail);
      const std::string what = line + ": " + std::strerror(number);
      if (number == EACCES || number == EPERM) {
        return what + "; give this user the right to open /dev/gpiochip*";
      }
      return what + "; its driver cannot do what is asked: direction, bias or edges";
    }
    default:
      return line + ": " + to_string(error.code);
  }
}

}  // namespace zonepack
