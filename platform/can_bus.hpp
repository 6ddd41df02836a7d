// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace zonepack {

// One frame of a CAN bus, classic or FD, as the kernel or a log hands it over.
struct CanFrame {
  std::int64_t stamp_ns = 0;  // CLOCK_REALTIME at reception
  std::uint32_t id = 0;       // 11 or 29 bits; of an error frame the class bits; no flag bits
  bool extended = false;      // 29-bit id
  bool fd = false;
  bool rtr = false;        // remote request: len is the length asked for, data is empty
  bool error = false;      // made by the controller, not sent by a node
  std::uint8_t flags = 0;  // FD only: 1 bit rate switch, 2 error state indicator
  std::uint8_t len = 0;    // bytes of data, at most 8, or 64 with FD
  std::array<std::uint8_t, 64> data{};
};

// A bus that frames are read from. Real-time: receive() neither blocks, allocates nor throws.
// Threads: one reader.
class CanBus {
 public:
  virtual ~CanBus() = default;

  // Takes up to into.size() frames that have arrived, in order of arrival; returns how many. The
  // rest stays for the next call, so the caller's span bounds its work per cycle.
  virtual std::size_t receive(std::span<CanFrame> into) noexcept = 0;

  // Frames lost before they could be read, since the start.
  virtual std::uint64_t dropped() const noexcept = 0;
};

}  // namespace zonepack
