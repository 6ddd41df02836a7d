// SPDX-License-Identifier: Apache-2.0
#include "platform/sim/sim_can_bus.hpp"

#include <algorithm>

namespace zonepack {

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

void SimCanBus::advance_to(std::int64_t now_ns) noexcept { now_ns_ = std::max(now_ns_, now_ns); }

std::optional<std::int64_t> SimCanBus::next_arrival_ns() noexcept {
  if (!fill()) return std::nullopt;
  return arrival_ns_;
}

std::size_t SimCanBus::receive(std::span<CanFrame> into) noexcept {
  std::size_t count = 0;
  while (count < into.size() && fill() && arrival_ns_ <= now_ns_) {
    into[count++] = *waiting_;
    waiting_.reset();
  }
  return count;
}

std::uint64_t SimCanBus::dropped() const noexcept {
  return lost_ + (source_ == nullptr ? 0 : source_->dropped());
}

}  // namespace zonepack
