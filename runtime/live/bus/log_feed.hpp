// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/can/can_log.hpp"
#include "platform/memory/spsc_queue.hpp"
#include "platform/process/realtime.hpp"
#include "platform/sim/sim_can_bus.hpp"
#include "runtime/live/cycle/control_loop.hpp"
#include "runtime/odometry/pose_filter.hpp"

namespace zonepack {

// Plays frames and corrections to a live control thread as a bus and a localizer would deliver
// them, on the time of a log: a cycle every period from the first frame to the last. A thread of
// its own reads ahead; the control thread waits for it, and for the watchers of the run, since a
// log can wait where a robot cannot.
//
// Threads: what RunClock and CanBus declare, by the control thread; the rest by its owner.
class LogFeed final : public RunClock {
 public:
  // `frames` is read by the feed's thread; it and `notes` must outlive this object.
  LogFeed(CanFrameSource& frames, std::vector<PoseCorrection> corrections, std::int64_t period_ns,
          const SpscQueue<LiveNote>& notes);
  ~LogFeed() override;

  // Reads the first frame, and goes on in a thread; kNotFound when there is none.
  Result<void> start();
  void stop() noexcept;
  // The same without waiting for the thread.
  void ask_stop() noexcept { stop_.store(true); }

  SimCanBus& bus() noexcept { return bus_; }
  SpscQueue<PoseCorrection>& corrections() noexcept { return corrections_; }
  // When the first frame arrives: the time of cycle 0. After start().
  std::int64_t start_ns() const noexcept { return start_ns_; }

  std::int64_t cycle_time_ns(std::uint64_t cycle, std::int64_t began_ns) noexcept override;
  bool await_inputs(std::uint64_t cycle) noexcept override;
  bool more() noexcept override;
  std::int64_t offset_ns() noexcept override { return 0; }

 private:
  // What the feed's thread has read, as the bus takes it.
  class Fed final : public CanFrameSource {
   public:
    explicit Fed(LogFeed& feed) : feed_(feed) {}
    std::optional<CanFrame> next() noexcept override;
    std::uint64_t dropped() const noexcept override { return feed_.dropped_.load(); }

   private:
    LogFeed& feed_;
  };

  void run();
  bool feed(const CanFrame& frame);
  bool feed_corrections(std::int64_t until_ns);

  CanFrameSource& source_;
  std::vector<PoseCorrection> all_corrections_;
  std::int64_t period_ns_;
  const SpscQueue<LiveNote>& notes_;
  SpscQueue<CanFrame> frames_;
  SpscQueue<PoseCorrection> corrections_;
  Fed fed_{*this};
  SimCanBus bus_{&fed_};
  std::int64_t start_ns_ = 0;
  std::optional<CanFrame> first_;
  std::size_t corrections_fed_ = 0;
  std::atomic<std::int64_t> fed_until_ns_{INT64_MIN};
  std::atomic<std::uint64_t> dropped_{0};
  std::atomic<bool> done_{false};
  std::atomic<bool> stop_{false};
  Thread thread_;
};

}  // namespace zonepack
