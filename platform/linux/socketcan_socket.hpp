// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "platform/base/result.hpp"
#include "platform/can/can_bus.hpp"
#include "platform/can/socketcan.hpp"
#include "platform/files/descriptor.hpp"

namespace zonepack {

// The interface that has a name now.
//
// Real-time: may wait in the kernel.
struct InterfaceState {
  int index = 0;  // 0: no such interface
  CanLink link = CanLink::kAbsent;
};
Result<InterfaceState> look_at_interface(const std::string& name) noexcept;

// A raw socket bound to the interface, reading classic and FD frames of the settings' ids and error
// frames, with stamps and counts of losses. kBadValue: not a CAN interface; kNotFound; kIo.
Result<Descriptor> open_can_socket(const SocketCanSettings& settings, int index) noexcept;

std::uint32_t receive_buffer_of(const Descriptor& socket) noexcept;

}  // namespace zonepack
