// SPDX-License-Identifier: Apache-2.0
#include "platform/linux/socketcan_message.hpp"

#include <asm/socket.h>
#include <linux/can/error.h>
#include <linux/errqueue.h>

#include <algorithm>
#include <cstring>

#include "platform/can/can_errors.hpp"

namespace zonepack {

static_assert(kCanErrorController == CAN_ERR_CRTL && kCanErrorBusOff == CAN_ERR_BUSOFF &&
              kCanErrorRestarted == CAN_ERR_RESTARTED);
static_assert(kCanControllerOverflow == CAN_ERR_CRTL_RX_OVERFLOW &&
              kCanControllerWarning == (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING) &&
              kCanControllerPassive == (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE) &&
              kCanControllerActive == CAN_ERR_CRTL_ACTIVE);
static_assert(CMSG_SPACE(3 * sizeof(__kernel_timespec)) + CMSG_SPACE(sizeof(std::uint32_t)) <=
              kSocketCanNoteBytes);

namespace {

// A stamp of zero means that none was taken.
std::optional<std::int64_t> stamp_of(const __kernel_timespec& time) noexcept {
  if (time.tv_sec == 0 && time.tv_nsec == 0) return std::nullopt;
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

std::optional<CanFrame> frame_from_socket(const canfd_frame& raw, std::size_t size) noexcept {
  if (size != CAN_MTU && size != CANFD_MTU) return std::nullopt;
  CanFrame frame;
  frame.fd = size == CANFD_MTU;
  frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.extended = !frame.error && (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.rtr = !frame.error && !frame.fd && (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.error || frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.len = std::min<std::uint8_t>(raw.len, frame.fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN);
  if (frame.fd) frame.flags = raw.flags & (CANFD_BRS | CANFD_ESI);
  if (!frame.rtr) std::memcpy(frame.data.data(), raw.data, frame.len);
  return frame;
}

SocketCanNotes notes_from_socket(const msghdr& message) noexcept {
  SocketCanNotes notes;
  auto* const whole = const_cast<msghdr*>(&message);
  for (cmsghdr* part = CMSG_FIRSTHDR(whole); part != nullptr; part = CMSG_NXTHDR(whole, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_TIMESTAMPING_NEW) {
      __kernel_timespec times[3];  // software, unused, hardware
      if (part->cmsg_len < CMSG_LEN(sizeof times)) continue;
      std::memcpy(times, CMSG_DATA(part), sizeof times);
      notes.software_ns = stamp_of(times[0]);
      notes.hardware_ns = stamp_of(times[2]);
    }
    if (part->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      if (part->cmsg_len < CMSG_LEN(sizeof dropped)) continue;
      std::memcpy(&dropped, CMSG_DATA(part), sizeof dropped);
      notes.dropped = dropped;
    }
  }
  return notes;
}

}  // namespace zonepack
