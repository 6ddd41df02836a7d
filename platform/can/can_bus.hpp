// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>

namespace zonepack {

// One frame of a CAN bus, classic or FD, as the kernel or a log delivers it.
struct CanFrame {
  std::int64_t stamp_ns = 0;  // at reception, on the clock of its source
  std::uint32_t id = 0;       // 11 or 29 bits; of an error frame the class bits; no flag bits
  bool extended = false;      // 29-bit id
  bool fd = false;
  bool rtr = false;        // remote request: len is the length asked for, data is empty
  bool error = false;      // made by the controller, not sent by a node
  std::uint8_t flags = 0;  // FD only: 1 bit rate switch, 2 error state indicator
  std::uint8_t len = 0;    // bytes of data, at most 8, or 64 with FD
  std::array<std::uint8_t, 64> data{};
};

struct CanId {
  std::uint32_t id = 0;  // 11 or 29 bits
  bool extended = false;
  friend auto operator<=>(const CanId&, const CanId&) = default;
};

enum class CanLink : std::uint8_t {
  kUp,
  kNoCarrier,  // up, but its controller does not take part: bus-off, or not started
  kDown,
  kAbsent,  // no interface of that name
};

// The error state that follows from a controller's error counters.
enum class CanBusState : std::uint8_t { kActive, kWarning, kPassive, kOff };

// The state of a bus; counts are since the start.
struct CanBusStatus {
  CanLink link = CanLink::kUp;
  CanBusState state = CanBusState::kActive;
  std::uint64_t dropped = 0;    // frames lost in the queue in front of this program
  std::uint64_t overflows = 0;  // times the controller itself lost frames
  std::uint64_t error_frames = 0;
  std::uint64_t bus_offs = 0;
  std::uint64_t restarts = 0;    // after a bus-off
  std::uint64_t reconnects = 0;  // the interface vanished or was replaced, and was reopened
  friend bool operator==(const CanBusStatus&, const CanBusStatus&) = default;
};

// A bus that frames are read from.
//
// Real-time: receive() neither blocks, allocates nor throws.
// Threads: one reader.
class CanBus {
 public:
  virtual ~CanBus() = default;

  // Takes up to into.size() frames that have arrived, in order of arrival; returns how many. The
  // rest waits for the next call, so the caller's span bounds the work per cycle.
  virtual std::size_t receive(std::span<CanFrame> into) noexcept = 0;

  // Frames lost before they could be read, since the start.
  virtual std::uint64_t dropped() const noexcept = 0;

  // As of the last receive().
  virtual CanBusStatus status() const noexcept { return {.dropped = dropped()}; }
};

}  // namespace zonepack
