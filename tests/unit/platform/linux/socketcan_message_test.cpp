// SPDX-License-Identifier: Apache-2.0
#include "platform/linux/socketcan_message.hpp"

#include <asm/socket.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/time_types.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace zonepack {
namespace {

canfd_frame raw_frame(std::uint32_t id, std::uint8_t len, std::uint8_t flags = 0) {
  canfd_frame raw{};
  raw.can_id = id;
  raw.len = len;
  raw.flags = flags;
  for (std::size_t i = 0; i < 64; ++i) raw.data[i] = static_cast<std::uint8_t>(i + 1);
  return raw;
}

TEST(FrameFromSocket, DistinguishesClassicFromFdByItsSize) {
  const auto classic = frame_from_socket(raw_frame(0x311, 8), CAN_MTU);
  ASSERT_TRUE(classic);
  EXPECT_FALSE(classic->fd || classic->extended || classic->rtr || classic->error);
  EXPECT_EQ(classic->id, 0x311u);
  EXPECT_EQ(classic->len, 8);
  EXPECT_EQ(classic->data[7], 8);
  const auto fd = frame_from_socket(raw_frame(0x311, 64, CANFD_BRS | 0x04), CANFD_MTU);
  ASSERT_TRUE(fd);
  EXPECT_TRUE(fd->fd);
  EXPECT_EQ(fd->flags, 1);  // the kernel's FDF bit is not one of ours
  EXPECT_EQ(fd->data[63], 64);
  EXPECT_FALSE(frame_from_socket(raw_frame(0x311, 8), 12));
}

TEST(FrameFromSocket, TakesTheFlagsOutOfTheId) {
  const auto extended = frame_from_socket(raw_frame(0x18FF1234u | CAN_EFF_FLAG, 2), CAN_MTU);
  EXPECT_TRUE(extended->extended);
  EXPECT_EQ(extended->id, 0x18FF1234u);
  const auto remote = frame_from_socket(raw_frame(0x221u | CAN_RTR_FLAG, 4), CAN_MTU);
  EXPECT_TRUE(remote->rtr);
  EXPECT_EQ(remote->len, 4);
  EXPECT_EQ(remote->data[0], 0);
  const auto error = frame_from_socket(raw_frame(CAN_ERR_FLAG | CAN_ERR_BUSOFF, 8), CAN_MTU);
  EXPECT_TRUE(error->error);
  EXPECT_FALSE(error->extended);
  EXPECT_EQ(error->id, CAN_ERR_BUSOFF);
}

TEST(FrameFromSocket, CutsLengthsThatNoFrameHas) {
  EXPECT_EQ(frame_from_socket(raw_frame(1, 255), CAN_MTU)->len, 8);
  EXPECT_EQ(frame_from_socket(raw_frame(1, 255), CANFD_MTU)->len, 64);
}

// Control data as the kernel lays it out.
class Control {
 public:
  template <typename T>
  Control& add(int type, const T& value, int level = SOL_SOCKET, std::size_t size = sizeof(T)) {
    auto* const part = reinterpret_cast<cmsghdr*>(bytes_.data() + used_);
    part->cmsg_level = level;
    part->cmsg_type = type;
    part->cmsg_len = CMSG_LEN(size);
    std::memcpy(CMSG_DATA(part), &value, std::min(size, sizeof value));
    used_ += CMSG_SPACE(size);
    return *this;
  }
  SocketCanNotes notes() {
    msghdr message{};
    message.msg_control = bytes_.data();
    message.msg_controllen = used_;
    return notes_from_socket(message);
  }

 private:
  alignas(cmsghdr) std::array<char, 512> bytes_{};
  std::size_t used_ = 0;
};

using Times = std::array<__kernel_timespec, 3>;

TEST(NotesFromSocket, GiveStampsOfBothKindsAndTheCountOfLosses) {
  const Times times{{{1'700'000'000, 5}, {}, {7, 250}}};
  const SocketCanNotes notes =
      Control().add(SO_TIMESTAMPING_NEW, times).add(SO_RXQ_OVFL, std::uint32_t{497}).notes();
  EXPECT_EQ(notes.software_ns, 1'700'000'000'000'000'005);
  EXPECT_EQ(notes.hardware_ns, 7'000'000'250);
  EXPECT_EQ(notes.dropped, 497u);
}

TEST(NotesFromSocket, HaveNoHardwareStampWhereTheControllerMakesNone) {
  const Times times{{{1'700'000'000, 5}, {}, {}}};
  const SocketCanNotes notes = Control().add(SO_TIMESTAMPING_NEW, times).notes();
  EXPECT_TRUE(notes.software_ns);
  EXPECT_FALSE(notes.hardware_ns);
  EXPECT_FALSE(notes.dropped);
}

TEST(NotesFromSocket, SkipWhatIsForeignOrTooShort) {
  const Times times{{{1, 2}, {}, {}}};
  const SocketCanNotes notes = Control()
                                   .add(SO_TIMESTAMPING_NEW, times, SOL_SOCKET, 16)
                                   .add(SO_RXQ_OVFL, std::uint32_t{1}, SOL_SOCKET, 2)
                                   .add(SO_RXQ_OVFL, std::uint32_t{2}, SOL_SOCKET + 1)
                                   .notes();
  EXPECT_FALSE(notes.software_ns || notes.hardware_ns || notes.dropped);
  EXPECT_FALSE(Control().notes().software_ns);
}

}  // namespace
}  // namespace zonepack
