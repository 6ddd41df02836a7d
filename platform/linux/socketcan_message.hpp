// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/can.h>
#include <sys/socket.h>

#include <cstddef>
#include <cstdint>
#include <optional>

#include "platform/can/can_bus.hpp"

// Decodes what a raw CAN socket delivers, without a socket.
//
// Real-time: no system calls.
namespace zonepack {

// A frame of `size` bytes as read: classic (CAN_MTU) or FD (CANFD_MTU); nothing for other sizes.
// A length greater than the frame can hold is cut. The stamp stays 0.
std::optional<CanFrame> frame_from_socket(const canfd_frame& raw, std::size_t size) noexcept;

// What came along with a frame.
struct SocketCanNotes {
  std::optional<std::int64_t> software_ns;  // CLOCK_REALTIME at arrival
  std::optional<std::int64_t> hardware_ns;  // by the controller's own clock
  std::optional<std::uint32_t> dropped;     // by this socket since it was opened, mod 2^32
};

// Reads SO_TIMESTAMPING_NEW and SO_RXQ_OVFL; skips other and malformed parts.
SocketCanNotes notes_from_socket(const msghdr& message) noexcept;

// Room for these notes.
inline constexpr std::size_t kSocketCanNoteBytes = 128;

}  // namespace zonepack
