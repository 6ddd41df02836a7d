// SPDX-License-Identifier: Apache-2.0
#include "platform/linux/socketcan_socket.hpp"

#include <asm/socket.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "platform/can/can_errors.hpp"

namespace zonepack {
namespace {

template <typename T>
bool set(int fd, int level, int name, const T& value) noexcept {
  return setsockopt(fd, level, name, &value, sizeof value) == 0;
}

bool set_filters(int fd, const std::vector<CanId>& ids) noexcept {
  if (ids.empty()) return true;
  // With exactly these masks the kernel finds the readers of a frame by its id alone.
  std::array<can_filter, CAN_RAW_FILTER_MAX> filters{};
  const std::size_t count = std::min(ids.size(), filters.size());
  for (std::size_t i = 0; i < count; ++i) {
    filters[i].can_id = ids[i].id | (ids[i].extended ? CAN_EFF_FLAG : 0u);
    filters[i].can_mask =
        CAN_EFF_FLAG | CAN_RTR_FLAG | (ids[i].extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  }
  return setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                    static_cast<socklen_t>(count * sizeof(can_filter))) == 0;
}

bool prepare(int fd, const SocketCanSettings& settings) noexcept {
  const int on = 1;
  const can_err_mask_t errors = kCanErrorsWatched;
  const int stamps = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE |
                     SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE;
  const int bytes = static_cast<int>(settings.receive_buffer_bytes);
  // CAP_NET_ADMIN allows more than net.core.rmem_max; granted_buffer_bytes() reports the result.
  if (!set(fd, SOL_SOCKET, SO_RCVBUFFORCE, bytes)) set(fd, SOL_SOCKET, SO_RCVBUF, bytes);
  return set(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on) &&
         set(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors) &&
         set(fd, SOL_SOCKET, SO_TIMESTAMPING_NEW, stamps) && set(fd, SOL_SOCKET, SO_RXQ_OVFL, on) &&
         set_filters(fd, settings.ids);
}

Error error_of(int number) noexcept {
  if (number == ENODEV) return {ErrorCode::kBadValue, number};
  return {ErrorCode::kIo, number};
}

}  // namespace

Result<InterfaceState> look_at_interface(const std::string& name) noexcept {
  InterfaceState state;
  ifreq request{};
  if (name.empty() || name.size() >= sizeof request.ifr_name) return state;
  std::memcpy(request.ifr_name, name.c_str(), name.size());
  const Descriptor any(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!any.is_open()) return {ErrorCode::kIo, errno};
  if (ioctl(any.get(), SIOCGIFINDEX, &request) != 0) return state;
  state.index = request.ifr_ifindex;
  if (ioctl(any.get(), SIOCGIFFLAGS, &request) != 0) return InterfaceState{};
  const unsigned flags = static_cast<unsigned>(request.ifr_flags);
  state.link = (flags & IFF_UP) == 0        ? CanLink::kDown
               : (flags & IFF_RUNNING) == 0 ? CanLink::kNoCarrier
                                            : CanLink::kUp;
  return state;
}

Result<Descriptor> open_can_socket(const SocketCanSettings& settings, int index) noexcept {
  Descriptor can(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW));
  if (!can.is_open() || !prepare(can.get(), settings)) return {ErrorCode::kIo, errno};
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  if (bind(can.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return error_of(errno);
  }
  return can;
}

std::uint32_t receive_buffer_of(const Descriptor& socket) noexcept {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  if (getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &bytes, &size) != 0) return 0;
  return static_cast<std::uint32_t>(bytes);
}

}  // namespace zonepack
