// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "runtime/control/cycle.hpp"
#include "runtime/control/input_sink.hpp"
#include "runtime/recording/byte_ring.hpp"
#include "runtime/recording/bytes.hpp"

namespace zonepack {

// A cycle as it leaves the tap: its inputs, and the state of the run before it.
struct TappedCycle {
  struct Head {
    std::uint64_t cycle = 0;  // from 0
    std::int64_t now_ns = 0;
    std::int64_t clock_offset_ns = 0;  // CLOCK_REALTIME minus the run's clock
    Pose2 T_map_base;
    double sigma_m = 0, sigma_rad = 0;
    std::uint32_t map = 1;          // number in the run of the map in use
    std::uint32_t offered_map = 0;  // that the cycle was offered; 0: none
    ZoneId zone = kNoZone;
    bool has_pose = false;
    bool lost = false;        // a localizer said so
    ZoneId sought = kNoZone;  // while lost
  };
  Head head;
  ByteSpan records;  // input_record.hpp
};

// Where the control thread leaves the inputs of each cycle, for a slower thread to record.
//
// A cycle that finds no room, or is larger than expected, is lost and counted; a reader of the
// recording sees the gap in the cycle numbers.
// Real-time: on_inputs() neither allocates nor waits; its work is bounded by the input.
// Threads: on_inputs() by the control thread, next() by one other, lost() by any.
class InputTap final : public InputSink {
 public:
  // Some seconds of a busy bus at 1 kHz, half a minute of a quiet one at 100 Hz.
  static constexpr std::size_t kRingBytes = std::size_t{512} * 1024;

  // most_frames: given to one cycle.
  explicit InputTap(std::uint32_t most_frames, std::size_t ring_bytes = kRingBytes);

  // Reads, for checkpoints, the state in which the last cycle left the run; call before the first
  // cycle. `state` must outlive the calls of on_inputs().
  void follow(const CycleState& state) noexcept { state_ = &state; }

  void on_inputs(std::uint64_t cycle, const CycleInput& input,
                 std::int64_t clock_offset_ns) noexcept override;

  // The oldest cycle not yet taken; its records are valid until the next call. False: none.
  bool next(TappedCycle& cycle);

  // The most bytes of records that next() can return.
  std::size_t most_cycle_bytes() const noexcept { return scratch_.size(); }

  std::uint64_t lost() const noexcept override { return lost_.load(std::memory_order_relaxed); }

 private:
  ByteRing ring_;
  const CycleState* state_ = nullptr;
  std::vector<std::byte> scratch_;  // of on_inputs()
  std::vector<std::byte> message_;  // of next()
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace zonepack
