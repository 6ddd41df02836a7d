// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/input_tap.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/odometry/se2.hpp"
#include "runtime/recording/input_record.hpp"

namespace zonepack {

InputTap::InputTap(std::uint32_t most_frames, std::size_t ring_bytes)
    : ring_(std::max(ring_bytes, 2 * (record_room(most_frames) + sizeof(TappedCycle::Head)))),
      scratch_(record_room(most_frames)),
      message_(record_room(most_frames) + sizeof(TappedCycle::Head)) {}

void InputTap::on_inputs(std::uint64_t cycle, const CycleInput& input,
                         std::int64_t clock_offset_ns) noexcept {
  TappedCycle::Head head;
  head.cycle = cycle;
  head.now_ns = input.now_ns;
  head.clock_offset_ns = clock_offset_ns;
  head.offered_map = input.offer.map;
  if (state_ != nullptr) {
    const PoseEstimate& pose = state_->pose;
    head.T_map_base = pose.T_map_base;
    head.sigma_m = position_sigma_m(pose.covariance);
    head.sigma_rad = std::sqrt(std::max(0.0, pose.covariance.yaw_yaw));
    head.zone = state_->zone;
    head.map = state_->map;
    head.has_pose = pose.valid;
    head.lost = state_->lost;
    head.sought = state_->sought;
  }
  ByteWriter records(scratch_);
  write_records(input, records);
  if (!records.ok() || !ring_.push(std::as_bytes(std::span(&head, 1)), records.written())) {
    lost_.fetch_add(1, std::memory_order_relaxed);
  }
}

bool InputTap::next(TappedCycle& cycle) {
  const std::size_t size = ring_.next_size();
  if (size == 0) return false;
  const std::span<std::byte> message = std::span(message_).first(size);
  ring_.pop(message);
  std::memcpy(&cycle.head, message.data(), sizeof cycle.head);
  cycle.records = message.subspan(sizeof cycle.head);
  return true;
}

}  // namespace zonepack
