// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "platform/can_bus.hpp"

namespace zonepack {

// Frames one after the other: a log, a list, a generator.
class CanFrameSource {
 public:
  virtual ~CanFrameSource() = default;
  virtual std::optional<CanFrame> next() noexcept = 0;
  // Frames known to be missing before the one that next() gave last.
  virtual std::uint64_t dropped() const noexcept { return 0; }
};

// A CAN bus in simulated time. A frame arrives at its stamp; one whose stamp lies before its
// predecessor's arrives together with that one and keeps its stamp. Order is never changed.
class SimCanBus final : public CanBus {
 public:
  // Without a source, only pushed frames arrive. The source must outlive the bus.
  explicit SimCanBus(CanFrameSource* source = nullptr) noexcept : source_(source) {}

  // Frames stamped up to and including now_ns can be received from here on; time never runs back.
  void advance_to(std::int64_t now_ns) noexcept;

  // Puts a frame behind those that wait (tests; allocates).
  void push(const CanFrame& frame) { pushed_.push_back(frame); }

  // The next `count` frames are lost and counted instead of being received.
  void lose(std::uint64_t count) noexcept { to_lose_ += count; }

  // When the next frame arrives; nullopt when none will.
  std::optional<std::int64_t> next_arrival_ns() noexcept;

  std::size_t receive(std::span<CanFrame> into) noexcept override;
  std::uint64_t dropped() const noexcept override;

 private:
  bool fill() noexcept;

  CanFrameSource* source_;
  std::deque<CanFrame> pushed_;
  std::optional<CanFrame> waiting_;
  std::int64_t arrival_ns_ = INT64_MIN;  // of waiting_; never falls
  std::int64_t now_ns_ = INT64_MIN;
  std::uint64_t to_lose_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace zonepack
