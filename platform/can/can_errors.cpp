// SPDX-License-Identifier: Apache-2.0
#include "platform/can/can_errors.hpp"

namespace zonepack {

void take_error_frame(const CanFrame& frame, CanBusStatus& status) noexcept {
  ++status.error_frames;
  if ((frame.id & kCanErrorRestarted) != 0) {
    ++status.restarts;
    status.state = CanBusState::kActive;
  }
  if ((frame.id & kCanErrorController) != 0) {
    const std::uint8_t controller = frame.data[1];
    if ((controller & kCanControllerOverflow) != 0) ++status.overflows;
    if ((controller & kCanControllerPassive) != 0) {
      status.state = CanBusState::kPassive;
    } else if ((controller & kCanControllerWarning) != 0) {
      status.state = CanBusState::kWarning;
    } else if ((controller & kCanControllerActive) != 0) {
      status.state = CanBusState::kActive;
    }
  }
  if ((frame.id & kCanErrorBusOff) != 0) {
    ++status.bus_offs;
    status.state = CanBusState::kOff;
  }
}

CanFrame error_frame(std::uint32_t classes, std::uint8_t controller) noexcept {
  CanFrame frame;
  frame.id = classes;
  frame.error = true;
  frame.len = 8;
  frame.data[1] = controller;
  return frame;
}

}  // namespace zonepack
