// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/can/can_bus.hpp"

// What error frames mean, numbered as in linux/can/error.h. Drivers translate the reports of every
// controller into these numbers, and candump writes them to logs.
namespace zonepack {

// Bits of an error frame's id.
inline constexpr std::uint32_t kCanErrorController = 0x004;  // details in data[1]
inline constexpr std::uint32_t kCanErrorBusOff = 0x040;
inline constexpr std::uint32_t kCanErrorRestarted = 0x100;
// The classes that change a CanBusStatus. Others (lost arbitration, missing acknowledgement, bus
// errors) may come with every frame of a disturbed bus, and affect the states anyway.
inline constexpr std::uint32_t kCanErrorsWatched =
    kCanErrorController | kCanErrorBusOff | kCanErrorRestarted;

// Bits of data[1].
inline constexpr std::uint8_t kCanControllerOverflow = 0x01;  // of reception
inline constexpr std::uint8_t kCanControllerWarning = 0x0C;
inline constexpr std::uint8_t kCanControllerPassive = 0x30;
inline constexpr std::uint8_t kCanControllerActive = 0x40;

// Counts an error frame and adopts the state that it reports; leaves `link` alone.
void take_error_frame(const CanFrame& frame, CanBusStatus& status) noexcept;

// An error frame of these classes; for simulation and tests.
CanFrame error_frame(std::uint32_t classes, std::uint8_t controller = 0) noexcept;

}  // namespace zonepack
