// SPDX-License-Identifier: Apache-2.0
#include "runtime/odometry/canopen_watch.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr std::uint32_t kHeartbeat = 0x700;
constexpr std::uint8_t kBootUp = 0;
constexpr std::uint8_t kOperational = 5;
constexpr std::uint8_t kStateBits = 0x7F;  // the highest one toggles in node guarding

bool is_data(const CanFrame& frame) noexcept {
  return !frame.error && !frame.rtr && !frame.extended && !frame.fd;
}

}  // namespace

CanOpenWatch::CanOpenWatch(const CanOpenWatchSettings& settings) noexcept
    : settings_(settings), healthy_(settings.node_count == 0 && settings.sync_timeout_s <= 0) {
  settings_.node_count = std::min(settings_.node_count, settings_.nodes.size());
}

void CanOpenWatch::look_at(Heard& heard, std::int64_t now_ns, double timeout_s,
                           std::uint64_t& lost) noexcept {
  if (!heard.alive) return;
  if (now_ns - heard.stamp_ns <= static_cast<std::int64_t>(timeout_s * 1e9 + 0.5)) return;
  heard.alive = false;
  ++lost;
}

bool CanOpenWatch::take_heartbeat(Heard& heard, const CanFrame& frame) noexcept {
  if (frame.len < 1) return false;
  const std::uint8_t state = frame.data[0] & kStateBits;
  const bool again = heard.ever && state == kBootUp;
  if (again) ++counters_.boots;
  if (heard.operational && state != kOperational) ++counters_.not_operational;
  heard = {frame.stamp_ns, true, true, state == kOperational};
  return again;
}

bool CanOpenWatch::take(const CanFrame& frame) noexcept {
  if (settings_.node_count == 0 && settings_.sync_timeout_s <= 0) return false;
  bool booted = false;
  bool healthy = true;
  for (std::size_t i = 0; i < settings_.node_count; ++i) {
    Heard& node = nodes_[i];
    look_at(node, frame.stamp_ns, settings_.heartbeat_timeout_s, counters_.heartbeats_lost);
    if (is_data(frame) && frame.id == kHeartbeat + settings_.nodes[i]) {
      booted = take_heartbeat(node, frame);
    }
    healthy = healthy && node.alive && node.operational;
  }
  if (settings_.sync_timeout_s > 0) {
    look_at(sync_, frame.stamp_ns, settings_.sync_timeout_s, counters_.sync_lost);
    if (is_data(frame) && frame.id == settings_.sync_id) sync_ = {frame.stamp_ns, true, true, true};
    healthy = healthy && sync_.alive;
  }
  healthy_ = healthy;
  return booted;
}

}  // namespace zonepack
