// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "platform/can/can_bus.hpp"

namespace zonepack {

struct CanOpenWatchSettings {
  static constexpr std::size_t kMostNodes = 8;
  std::array<std::uint8_t, kMostNodes> nodes{};  // ids 1 to 127 whose heartbeats are watched
  std::size_t node_count = 0;
  double heartbeat_timeout_s = 0.5;
  double sync_timeout_s = 0;  // 0: SYNC is not watched
  std::uint32_t sync_id = 0x80;
};

struct CanOpenCounters {
  std::uint64_t heartbeats_lost = 0;  // times a node fell silent
  std::uint64_t not_operational = 0;  // times a node left the operational state
  std::uint64_t boots = 0;            // boot-up messages of nodes that were alive before
  std::uint64_t sync_lost = 0;        // times SYNC fell silent
};

// Whether the drives whose process data is read are alive: all watched nodes are operational and
// were heard within their timeout, and so was SYNC. Time is that of the frames' stamps.
// Source: CiA 301, "CANopen application layer and communication profile": heartbeat 0x700 + node
// with the state in one byte (0 boot-up, 4 stopped, 5 operational, 127 pre-operational), SYNC 0x80.
// Real-time: no allocation, at most kMostNodes + 1 comparisons a frame.
// Threads: one.
class CanOpenWatch {
 public:
  explicit CanOpenWatch(const CanOpenWatchSettings& settings) noexcept;

  // Takes any frame of the bus. True when a node that was alive before has restarted, so that its
  // counters may have been reset.
  bool take(const CanFrame& frame) noexcept;

  // As of the newest frame taken. Always true when nothing is watched.
  bool healthy() const noexcept { return healthy_; }

  const CanOpenCounters& counters() const noexcept { return counters_; }

 private:
  struct Heard {
    std::int64_t stamp_ns = 0;
    bool ever = false;
    bool alive = false;
    bool operational = false;
  };
  void look_at(Heard& heard, std::int64_t now_ns, double timeout_s, std::uint64_t& lost) noexcept;
  bool take_heartbeat(Heard& heard, const CanFrame& frame) noexcept;

  CanOpenWatchSettings settings_;
  std::array<Heard, CanOpenWatchSettings::kMostNodes> nodes_{};
  Heard sync_;
  bool healthy_;
  CanOpenCounters counters_;
};

}  // namespace zonepack
