// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_can_bus.hpp"

#include <algorithm>

#include "platform/can/can_errors.hpp"

namespace zonepack {

void SimCanBus::limit_queue(std::size_t frames) { queue_.resize(frames); }

bool SimCanBus::lets_through(const CanFrame& frame) const noexcept {
  if (status_.link != CanLink::kUp && status_.link != CanLink::kNoCarrier) return false;
  if (frame.error || ids_.empty()) return true;
  return !frame.rtr &&
         std::find(ids_.begin(), ids_.end(), CanId{frame.id, frame.extended}) != ids_.end();
}

bool SimCanBus::fill() noexcept {
  while (!waiting_) {
    if (!pushed_.empty()) {
      waiting_ = pushed_.front();
      pushed_.pop_front();
    } else if (source_ != nullptr) {
      waiting_ = source_->next();
    }
    if (!waiting_) return false;
    arrival_ns_ = std::max(arrival_ns_, waiting_->stamp_ns);
    if (to_lose_ > 0) {
      --to_lose_;
      ++lost_;
      waiting_.reset();
    }
  }
  return true;
}

void SimCanBus::set_link(CanLink link) noexcept {
  const bool opened = status_.link == CanLink::kAbsent && link != CanLink::kAbsent;
  if (link == CanLink::kUp && status_.link != link) status_.state = CanBusState::kActive;
  status_.link = link;
  status_.reconnects += opened;
}

void SimCanBus::follow_plan(std::int64_t until_ns) noexcept {
  while (planned_ < plan_.size() && plan_[planned_].at_ns <= until_ns) {
    set_link(plan_[planned_++].link);
  }
}

// Takes the next frame that has arrived and passes the filter.
bool SimCanBus::take_arrived(CanFrame& frame) noexcept {
  while (fill() && arrival_ns_ <= now_ns_) {
    follow_plan(arrival_ns_);
    frame = *waiting_;
    waiting_.reset();
    if (lets_through(frame)) return true;
  }
  follow_plan(now_ns_);
  return false;
}

void SimCanBus::advance_to(std::int64_t now_ns) noexcept {
  now_ns_ = std::max(now_ns_, now_ns);
  CanFrame frame;
  while (!queue_.empty() && take_arrived(frame)) {
    if (queued_ == queue_.size()) {
      ++lost_;
    } else {
      queue_[(first_ + queued_++) % queue_.size()] = frame;
    }
  }
}

std::optional<std::int64_t> SimCanBus::next_arrival_ns() noexcept {
  if (queued_ > 0) return queue_[first_].stamp_ns;
  if (!fill()) return std::nullopt;
  return arrival_ns_;
}

std::size_t SimCanBus::receive(std::span<CanFrame> into) noexcept {
  std::size_t count = 0;
  while (count < into.size()) {
    CanFrame& frame = into[count];
    if (queued_ > 0) {
      frame = queue_[first_];
      first_ = (first_ + 1) % queue_.size();
      --queued_;
    } else if (!queue_.empty() || !take_arrived(frame)) {
      break;
    }
    if (frame.error) take_error_frame(frame, status_);
    ++count;
  }
  return count;
}

std::uint64_t SimCanBus::dropped() const noexcept {
  return lost_ + (source_ == nullptr ? 0 : source_->dropped());
}

CanBusStatus SimCanBus::status() const noexcept {
  CanBusStatus status = status_;
  status.dropped = dropped();
  return status;
}

}  // namespace zonepack
