// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/can/can_bus.hpp"

namespace zonepack {

struct SocketCanSettings {
  std::string interface = {};
  // What the kernel lets through: data frames of these ids, at most 512. Empty: every frame.
  // Error frames that report the controller's state always come.
  std::vector<CanId> ids = {};
  // Requested from the kernel, which doubles it: one second of a full bus of shortest frames at
  // 1 Mbit/s (47 bits, 21,277 frames), each of which takes 768 bytes or a little more there.
  std::uint32_t receive_buffer_bytes = 10 << 20;
  bool wait_for_interface = false;  // accept an interface that is absent or down
};

// A CAN interface of the kernel, classic or FD; never sends.
//
// Frames are stamped on CLOCK_MONOTONIC at arrival, by the controller where it can, else by the
// kernel. An interface that goes down delivers nothing until it is up again. One that is removed or
// renamed is given up, and the next interface with the name is opened instead; status() reports it.
// An ordinary thread, asleep except for a check every tenth of a second, opens and closes sockets,
// since both may wait in the kernel; it passes them to the reader through atomics.
//
// Real-time: receive() makes at most into.size() / 64 + 2 calls of recvmmsg, none of which waits,
// into buffers allocated at the start.
class SocketCanBus : public CanBus {
 public:
  // Errors: kNotFound: no such interface; kBadValue: it is not a CAN interface; kIo with errno:
  // ENETDOWN: it is down; EAFNOSUPPORT: the kernel has no CAN.
  static Result<std::unique_ptr<SocketCanBus>> open(const SocketCanSettings& settings);

  // Bytes that the kernel granted, by its own count: twice the request. 0 while there is no
  // interface.
  virtual std::uint32_t granted_buffer_bytes() const noexcept = 0;
};

// The message for an error of open(): what is wrong and the command that fixes it.
std::string explain_socketcan(const std::string& interface, const Error& error);

}  // namespace zonepack
