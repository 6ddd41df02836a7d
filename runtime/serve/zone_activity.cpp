// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/zone_activity.hpp"

#include <algorithm>

namespace zonepack {

void ZoneActivity::take(const Event& event) {
  const bool counts = event.kind == EventKind::kZoneEntered ||
                      event.kind == EventKind::kLoadStarted || event.kind == EventKind::kLoadDone ||
                      event.kind == EventKind::kEvicted;
  if (!counts || event.zone == kNoZone) return;
  Row* const row = find_or_add(event.zone);
  if (row == nullptr) return;
  switch (event.kind) {
    case EventKind::kZoneEntered:
      ++row->entered;
      return;
    case EventKind::kLoadStarted:
      row->load_began_ns = event.t_ns;
      return;
    case EventKind::kLoadDone:
      ++row->loads;
      row->last_load_ns = event.t_ns - row->load_began_ns;
      return;
    default:
      ++row->evictions;
  }
}

ZoneActivity::Row ZoneActivity::of(ZoneId zone) const noexcept {
  const auto found = std::ranges::lower_bound(rows_, zone, {}, &Row::zone);
  return found != rows_.end() && found->zone == zone ? *found : Row{};
}

ZoneActivity::Row* ZoneActivity::find_or_add(ZoneId zone) {
  if (rows_.capacity() == 0) rows_.reserve(kMostZones);
  const auto found = std::ranges::lower_bound(rows_, zone, {}, &Row::zone);
  if (found != rows_.end() && found->zone == zone) return &*found;
  if (rows_.size() == kMostZones) return nullptr;
  return &*rows_.insert(found, Row{.zone = zone});
}

}  // namespace zonepack
