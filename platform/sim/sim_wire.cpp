// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_wire.hpp"

#include <algorithm>
#include <utility>

#include "platform/can/can_errors.hpp"

namespace zonepack {
namespace {

using Fault = SimFault::Kind;

constexpr std::uint32_t kErrorFrameBits = 31;  // with the pause after it, at most

// The lower value wins: the bits in sending order, up to the one that separates standard from
// extended ids.
std::uint64_t arbitration_key(const CanFrame& frame) noexcept {
  const std::uint64_t base = frame.extended ? frame.id >> 18u : frame.id;
  const std::uint64_t rest = frame.extended ? frame.id & 0x3FFFFu : 0;
  return (base << 21u) | (std::uint64_t{frame.extended} << 20u) | (rest << 1u) |
         std::uint64_t{frame.rtr};
}

}  // namespace

FrameBits bits_of(const CanFrame& frame) noexcept {
  const std::uint32_t len = frame.rtr ? 0 : frame.len;
  if (!frame.fd) return {(frame.extended ? 80u : 55u) + 10u * len, 0};
  // ISO 11898-1: 17 or 21 bits of checksum with fixed stuff bits and a count of stuff bits.
  const std::uint32_t checksum = len <= 16 ? 26 : 31;
  const std::uint32_t payload = 5 + 8 * len;
  return {frame.extended ? 59u : 35u, payload + payload / 4 + checksum};
}

SimWire::SimWire(SimWireSettings settings, const std::vector<CanFrameSource*>& nodes)
    : settings_(std::move(settings)) {
  for (CanFrameSource* source : nodes) nodes_.push_back({source, source->next()});
  first_ns_ = INT64_MAX;
  for (const Node& node : nodes_) {
    if (node.ready) first_ns_ = std::min(first_ns_, node.ready->stamp_ns);
  }
  if (first_ns_ == INT64_MAX) first_ns_ = 0;
  std::stable_sort(settings_.faults.begin(), settings_.faults.end(),
                   [](const SimFault& a, const SimFault& b) { return a.at_ns < b.at_ns; });
  std::vector<Report> reports;
  for (const SimFault& fault : settings_.faults) {
    const std::int64_t at_ns = first_ns_ + fault.at_ns;
    if (fault.kind == Fault::kBusOff) {
      reports.push_back({at_ns, error_frame(kCanErrorBusOff)});
      reports.push_back({at_ns + fault.for_ns, error_frame(kCanErrorRestarted)});
    }
    if (fault.kind == Fault::kPassive) {
      reports.push_back({at_ns, error_frame(kCanErrorController, kCanControllerPassive)});
      reports.push_back(
          {at_ns + fault.for_ns, error_frame(kCanErrorController, kCanControllerActive)});
    }
  }
  std::stable_sort(reports.begin(), reports.end(),
                   [](const Report& a, const Report& b) { return a.at_ns < b.at_ns; });
  reports_.assign(reports.begin(), reports.end());
}

std::vector<CanLinkChange> SimWire::links() const {
  std::vector<CanLinkChange> changes;
  for (const SimFault& fault : settings_.faults) {
    if (fault.kind != Fault::kDown && fault.kind != Fault::kAbsent) continue;
    const std::int64_t at_ns = first_ns_ + fault.at_ns;
    changes.push_back({at_ns, fault.kind == Fault::kDown ? CanLink::kDown : CanLink::kAbsent});
    changes.push_back({at_ns + fault.for_ns, CanLink::kUp});
  }
  std::stable_sort(changes.begin(), changes.end(),
                   [](const auto& a, const auto& b) { return a.at_ns < b.at_ns; });
  return changes;
}

std::int64_t SimWire::duration_ns(const CanFrame& frame) const noexcept {
  if (settings_.bit_rate == 0) return 0;
  const bool switches = frame.fd && (frame.flags & 1) != 0 && settings_.data_bit_rate > 0;
  const std::uint64_t data_rate = switches ? settings_.data_bit_rate : settings_.bit_rate;
  const FrameBits bits = bits_of(frame);
  return static_cast<std::int64_t>(bits.arbitration * 1'000'000'000ull / settings_.bit_rate +
                                   bits.data * 1'000'000'000ull / data_rate);
}

const SimFault* SimWire::active(Fault kind, std::int64_t now_ns) const noexcept {
  for (const SimFault& fault : settings_.faults) {
    const std::int64_t since_ns = now_ns - first_ns_ - fault.at_ns;
    if (since_ns < 0) break;
    if (fault.kind == kind && since_ns < fault.for_ns) return &fault;
  }
  return nullptr;
}

bool SimWire::is_lost(std::int64_t sent_ns) noexcept {
  if (active(Fault::kBusOff, sent_ns) != nullptr || active(Fault::kDrop, sent_ns) != nullptr) {
    return true;
  }
  if (active(Fault::kOverflow, sent_ns) != nullptr) {
    ++overflowed_;
    return true;
  }
  for (SimFault& fault : settings_.faults) {
    if (sent_ns - first_ns_ < fault.at_ns) break;
    if (fault.count == 0 || (fault.kind != Fault::kDrop && fault.kind != Fault::kOverflow))
      continue;
    --fault.count;
    overflowed_ += fault.kind == Fault::kOverflow;
    return true;
  }
  return false;
}

SimWire::Node* SimWire::next_sender() noexcept {
  std::int64_t earliest_ns = INT64_MAX;
  for (const Node& node : nodes_) {
    if (node.ready) earliest_ns = std::min(earliest_ns, node.ready->stamp_ns);
  }
  const std::int64_t start_ns = std::max(earliest_ns, free_ns_);
  Node* winner = nullptr;
  for (Node& node : nodes_) {
    if (!node.ready || node.ready->stamp_ns > start_ns) continue;
    if (winner == nullptr || arbitration_key(*node.ready) < arbitration_key(*winner->ready)) {
      winner = &node;
    }
  }
  return winner;
}

std::optional<CanFrame> SimWire::next() noexcept {
  while (nodes_.front().ready) {
    Node* const sender = next_sender();
    CanFrame frame = *sender->ready;
    const std::int64_t ready_ns = frame.stamp_ns;
    const std::int64_t start_ns = settings_.bit_rate == 0 ? ready_ns : std::max(ready_ns, free_ns_);
    if (!reports_.empty() && reports_.front().at_ns <= start_ns) {
      CanFrame error = reports_.front().frame;
      error.stamp_ns = reports_.front().at_ns;
      reports_.pop_front();
      return error;
    }
    waited_ += start_ns > ready_ns;
    std::int64_t took_ns = duration_ns(frame);
    if (active(Fault::kNoise, start_ns) != nullptr && settings_.bit_rate > 0) {
      took_ns += took_ns +
                 static_cast<std::int64_t>(kErrorFrameBits * 1'000'000'000ull / settings_.bit_rate);
    }
    frame.stamp_ns = start_ns + took_ns;
    free_ns_ = std::max(free_ns_, frame.stamp_ns);
    sender->ready = sender->source->next();
    if (is_lost(start_ns)) continue;
    if (const SimFault* const delay = active(Fault::kDelay, frame.stamp_ns)) {
      frame.stamp_ns = first_ns_ + delay->at_ns + delay->for_ns;
    }
    return frame;
  }
  if (reports_.empty()) return std::nullopt;
  CanFrame error = reports_.front().frame;
  error.stamp_ns = reports_.front().at_ns;
  reports_.pop_front();
  return error;
}

std::uint64_t SimWire::dropped() const noexcept {
  std::uint64_t dropped = overflowed_;
  for (const Node& node : nodes_) dropped += node.source->dropped();
  return dropped;
}

}  // namespace zonepack
