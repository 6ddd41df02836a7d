// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/resident_zones.hpp"

#include <utility>

namespace zonepack {

void ResidentZones::publish(ZoneId zone, std::uint32_t generation, const SlotChain&) noexcept {
  withdraw(zone);
  if (filler_ == nullptr) return;
  // Only a zone whose tables contradict each other makes no view; the robot's readers refuse it
  // too.
  auto view = ZoneView::make(filler_->chunks(zone));
  if (view) zones_.push_back({zone, generation, std::move(*view)});
}

void ResidentZones::withdraw(ZoneId zone) noexcept {
  std::erase_if(zones_, [zone](const Zone& held) { return held.zone == zone; });
}

Result<void> ResidentZones::begin_map(std::uint32_t) noexcept {
  zones_.clear();
  return {};
}

}  // namespace zonepack
