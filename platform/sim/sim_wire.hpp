// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "platform/sim/sim_can_bus.hpp"

namespace zonepack {

// A fault on a simulated wire, or at our end of it.
struct SimFault {
  enum class Kind : std::uint8_t {
    kBusOff,    // our controller leaves the bus and restarts at the end
    kPassive,   // our controller is error passive until the end; frames still arrive
    kDrop,      // frames are lost unnoticed: the next `count`, or all until the end
    kOverflow,  // the same, but the kernel counts them
    kDelay,     // frames wait until the end, then arrive at once
    kNoise,     // each frame is destroyed once and sent again
    kDown,      // the interface is down until the end
    kAbsent,    // the interface is gone until the end
  };
  Kind kind = Kind::kDrop;
  std::int64_t at_ns = 0;  // after the first frame
  std::int64_t for_ns = 0;
  std::uint32_t count = 0;  // kDrop, kOverflow; 0: those until the end
};

struct SimWireSettings {
  std::uint64_t bit_rate = 0;       // bit/s; 0: frames take no time
  std::uint64_t data_bit_rate = 0;  // of FD frames with a bit rate switch; 0: the same
  std::vector<SimFault> faults = {};
};

// Bits on a wire, with the most stuff bits possible and the pause after the frame. Classic:
// 55 + 10 len, extended 80 + 10 len (Davis, Burns, Bril, Lukkien, "Controller Area Network (CAN)
// schedulability analysis", 2007). FD: bits sent at each of its two rates.
struct FrameBits {
  std::uint32_t arbitration = 0;
  std::uint32_t data = 0;
};
FrameBits bits_of(const CanFrame& frame) noexcept;

// A wire to which several nodes send, each in its own order: a frame is ready at its stamp, waits
// while the wire is busy, and is sent when it has the lowest id of the ready frames; its stamp
// becomes the end of its last bit. The sequence ends when the first node's ends. Faults apply at
// their times.
class SimWire final : public CanFrameSource {
 public:
  // The nodes, at least one, must outlive the wire. Sorts the faults by time.
  SimWire(SimWireSettings settings, const std::vector<CanFrameSource*>& nodes);

  std::optional<CanFrame> next() noexcept override;
  std::uint64_t dropped() const noexcept override;

  // The link changes that the faults cause, for the bus on this wire; known once started.
  std::vector<CanLinkChange> links() const;

  // Frames that were ready but had to wait for the wire.
  std::uint64_t waited() const noexcept { return waited_; }

 private:
  struct Node {
    CanFrameSource* source;
    std::optional<CanFrame> ready;
  };
  Node* next_sender() noexcept;
  std::int64_t duration_ns(const CanFrame& frame) const noexcept;
  const SimFault* active(SimFault::Kind kind, std::int64_t now_ns) const noexcept;
  bool is_lost(std::int64_t sent_ns) noexcept;

  SimWireSettings settings_;
  std::vector<Node> nodes_;
  struct Report {
    std::int64_t at_ns;
    CanFrame frame;
  };
  std::deque<Report> reports_;  // error frames to come
  std::int64_t first_ns_ = 0;
  std::int64_t free_ns_ = INT64_MIN;  // when the wire is
  std::uint64_t overflowed_ = 0;
  std::uint64_t waited_ = 0;
};

}  // namespace zonepack
