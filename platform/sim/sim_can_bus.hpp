// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "platform/can/can_bus.hpp"
#include "platform/can/can_frame_source.hpp"

namespace zonepack {

// A link state from at_ns on.
struct CanLinkChange {
  std::int64_t at_ns = 0;
  CanLink link = CanLink::kUp;
};

// A CAN bus in simulated time, seen through an interface as the kernel presents it. A frame arrives
// at its stamp; a frame stamped before its predecessor arrives together with it and keeps its
// stamp. The order never changes. Frames that arrive while the link is not up are not received.
class SimCanBus final : public CanBus {
 public:
  // Without a source, only pushed frames arrive. The source must outlive the bus.
  explicit SimCanBus(CanFrameSource* source = nullptr) noexcept : source_(source) {}

  // To be called before the first frame. Each allocates.
  void limit_queue(std::size_t frames);  // like a socket's buffer; default: no limit
  void only(std::vector<CanId> ids) { ids_ = std::move(ids); }  // and error frames; default: all
  void plan(std::vector<CanLinkChange> changes) { plan_ = std::move(changes); }  // by time

  // From now on, frames stamped up to and including now_ns can be received; time never runs back.
  void advance_to(std::int64_t now_ns) noexcept;

  // Adds a frame after those that wait (for tests; allocates).
  void push(const CanFrame& frame) { pushed_.push_back(frame); }

  // Loses and counts the next `count` frames instead of receiving them.
  void lose(std::uint64_t count) noexcept { to_lose_ += count; }

  // Applies until the plan changes it.
  void set_link(CanLink link) noexcept;

  // When the next frame arrives, or has arrived; nullopt when none will.
  std::optional<std::int64_t> next_arrival_ns() noexcept;

  std::size_t receive(std::span<CanFrame> into) noexcept override;
  std::uint64_t dropped() const noexcept override;
  CanBusStatus status() const noexcept override;

 private:
  bool fill() noexcept;
  bool take_arrived(CanFrame& frame) noexcept;
  void follow_plan(std::int64_t until_ns) noexcept;
  bool lets_through(const CanFrame& frame) const noexcept;

  CanFrameSource* source_;
  std::vector<CanId> ids_;
  std::vector<CanLinkChange> plan_;
  std::size_t planned_ = 0;  // changes already applied
  std::deque<CanFrame> pushed_;
  std::optional<CanFrame> waiting_;
  std::int64_t arrival_ns_ = INT64_MIN;  // of waiting_; never falls
  std::int64_t now_ns_ = INT64_MIN;
  std::vector<CanFrame> queue_;  // a ring, with a limit only
  std::size_t first_ = 0;
  std::size_t queued_ = 0;
  std::uint64_t to_lose_ = 0;
  std::uint64_t lost_ = 0;
  CanBusStatus status_;
};

}  // namespace zonepack
