// SPDX-License-Identifier: Apache-2.0
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "platform/can/can_errors.hpp"
#include "platform/can/socketcan.hpp"
#include "platform/files/descriptor.hpp"
#include "platform/linux/socketcan_keeper.hpp"
#include "platform/linux/socketcan_message.hpp"
#include "platform/process/clock.hpp"
#include "platform/process/stamp_converter.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kBatch = 64;
constexpr std::int64_t kOpenedBefore_ns = 1'000'000'000;  // how long a new socket may have waited

class Bus final : public SocketCanBus {
 public:
  explicit Bus(const SocketCanSettings& settings);

  Result<void> start() { return keeper_.start(); }
  std::size_t receive(std::span<CanFrame> into) noexcept override;
  std::uint64_t dropped() const noexcept override { return status_.dropped; }
  CanBusStatus status() const noexcept override { return status_; }
  std::uint32_t granted_buffer_bytes() const noexcept override {
    return keeper_.granted_buffer_bytes();
  }

 private:
  void follow_keeper() noexcept;
  std::size_t read_batch(std::size_t most) noexcept;
  bool take(std::size_t i, CanFrame& frame) noexcept;

  SocketCanKeeper keeper_;
  Descriptor socket_;
  CanBusStatus status_;
  StampConverter stamps_{clock_offset_ns()};
  HardwareStamps hardware_;
  std::uint32_t dropped_by_socket_ = 0;
  bool had_socket_ = false;
  bool emptied_ = false;  // by the last receive
  std::array<canfd_frame, kBatch> raw_{};
  std::array<iovec, kBatch> places_{};
  std::array<mmsghdr, kBatch> messages_{};
  struct alignas(cmsghdr) Notes {
    std::array<std::byte, kSocketCanNoteBytes> bytes{};
  };
  std::array<Notes, kBatch> notes_{};
};

Bus::Bus(const SocketCanSettings& settings) : keeper_(settings) {
  status_.link = CanLink::kAbsent;
  for (std::size_t i = 0; i < kBatch; ++i) {
    places_[i] = {&raw_[i], sizeof raw_[i]};
    messages_[i].msg_hdr.msg_iov = &places_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
    messages_[i].msg_hdr.msg_control = notes_[i].bytes.data();
  }
}

void Bus::follow_keeper() noexcept {
  const CanLink link = keeper_.link();
  if (link == CanLink::kUp && status_.link != CanLink::kUp) status_.state = CanBusState::kActive;
  status_.link = link;
  const auto fd = keeper_.take_new(socket_.get());
  if (!fd) return;
  static_cast<void>(socket_.release());  // the keeper owns it now
  socket_ = Descriptor(*fd);
  if (!socket_.is_open()) return;
  status_.reconnects += had_socket_;
  had_socket_ = true;
  dropped_by_socket_ = 0;
  hardware_ = {};
  stamps_.restart(monotonic_ns() - kOpenedBefore_ns);
}

std::size_t Bus::read_batch(std::size_t most) noexcept {
  const std::int64_t began_ns = monotonic_ns();
  for (std::size_t i = 0; i < most; ++i) messages_[i].msg_hdr.msg_controllen = kSocketCanNoteBytes;
  const auto read = [this, most] {
    return recvmmsg(socket_.get(), messages_.data(), static_cast<unsigned>(most), MSG_DONTWAIT,
                    nullptr);
  };
  int count = read();
  // Reported once when the interface goes down; the socket keeps earlier frames and works again
  // later.
  if (count < 0 && errno == ENETDOWN) count = read();
  const int error = count < 0 ? errno : 0;
  stamps_.read_between(began_ns, monotonic_ns(), clock_offset_ns());
  const std::size_t messages = count < 0 ? 0 : static_cast<std::size_t>(count);
  emptied_ = error == EAGAIN || (error == 0 && messages < most);
  if (error != 0 && error != EAGAIN && error != EINTR && error != ENETDOWN) keeper_.lost();
  return messages;
}

bool Bus::take(std::size_t i, CanFrame& frame) noexcept {
  const SocketCanNotes notes = notes_from_socket(messages_[i].msg_hdr);
  if (notes.dropped) {
    status_.dropped += static_cast<std::uint32_t>(*notes.dropped - dropped_by_socket_);
    dropped_by_socket_ = *notes.dropped;
  }
  const auto received = frame_from_socket(raw_[i], messages_[i].msg_len);
  if (!received) return false;
  frame = *received;
  const std::int64_t software_ns =
      notes.software_ns ? stamps_.monotonic_of(*notes.software_ns) : monotonic_ns();
  frame.stamp_ns =
      notes.hardware_ns ? hardware_.monotonic_of(*notes.hardware_ns, software_ns) : software_ns;
  if (frame.error) take_error_frame(frame, status_);
  return true;
}

std::size_t Bus::receive(std::span<CanFrame> into) noexcept {
  follow_keeper();
  std::size_t count = 0;
  while (socket_.is_open() && count < into.size()) {
    const std::size_t most = std::min(kBatch, into.size() - count);
    const std::size_t read = read_batch(most);
    for (std::size_t i = 0; i < read; ++i) count += take(i, into[count]);
    if (emptied_) stamps_.emptied();
    if (read < most) break;
  }
  return count;
}

// A virtual bus has no bit rate.
std::string how_to_bring_up(const std::string& interface) {
  const bool hardware = std::filesystem::exists("/sys/class/net/" + interface + "/device");
  return "; bring it up: ip link set " + interface + " up" +
         (hardware ? " type can bitrate 500000 (the bit rate of the robot's bus)" : "");
}

std::string how_to_make(const std::string& interface) {
  if (interface.starts_with("vcan")) {
    return "; make it: ip link add " + interface + " type vcan && ip link set " + interface + " up";
  }
  return "; plug in its adapter or load its driver; then ip link set " + interface +
         " up type can bitrate 500000 (the bit rate of the robot's bus)";
}

}  // namespace

Result<std::unique_ptr<SocketCanBus>> SocketCanBus::open(const SocketCanSettings& settings) {
  auto bus = std::make_unique<Bus>(settings);
  if (const auto started = bus->start(); !started) return started.error();
  return std::unique_ptr<SocketCanBus>(std::move(bus));
}

std::string explain_socketcan(const std::string& interface, const Error& error) {
  if (error.code == ErrorCode::kNotFound) {
    return interface + ": no such network interface" + how_to_make(interface);
  }
  if (error.code == ErrorCode::kBadValue) {
    return interface +
           ": not a CAN interface; ip -details link show type can lists those there are";
  }
  if (error.detail == ENETDOWN) return interface + ": is down" + how_to_bring_up(interface);
  if (error.detail == EAFNOSUPPORT || error.detail == EPROTONOSUPPORT) {
    return interface +
           ": this kernel has no CAN; load it: modprobe can-raw, or take a kernel with "
           "CONFIG_CAN_RAW";
  }
  return interface + ": cannot be opened: " + std::strerror(static_cast<int>(error.detail));
}

}  // namespace zonepack
