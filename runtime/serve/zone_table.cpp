// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/zone_table.hpp"

namespace zonepack {
namespace {

bool is_filling(ZoneState state) noexcept {
  return state == ZoneState::kFilling || state == ZoneState::kCancelling;
}

}  // namespace

ZoneTable::ZoneTable(std::size_t zones, std::span<const ZoneId> pinned) : rows_(zones) {
  for (const ZoneId zone : pinned) set_pinned(zone, true);
}

void ZoneTable::take(const Event& event) noexcept {
  if (event.zone >= rows_.size()) return;
  Row& row = rows_[event.zone];
  if (event.kind == EventKind::kZoneWanted || event.kind == EventKind::kZoneUnwanted) {
    row.wanted = event.kind == EventKind::kZoneWanted;
    return;
  }
  // After a resync, what is still in the queue may be older than what was read.
  if (event.generation < row.generation) return;
  const auto becomes = [&](ZoneState state) {
    const bool is_new = event.generation != row.generation;
    row.generation = event.generation;
    if (is_new && row.resident() && state == ZoneState::kResident) mark_changed(event.zone);
    set_state(event.zone, state);
  };
  switch (event.kind) {
    case EventKind::kLoadStarted:
      if (event.generation != row.generation || !row.resident()) becomes(ZoneState::kFilling);
      return;
    case EventKind::kLoadCancelled:
      if (is_filling(row.state)) becomes(ZoneState::kCancelling);
      return;
    case EventKind::kLoadDone:
    case EventKind::kZoneKept:
      return becomes(ZoneState::kResident);
    case EventKind::kLoadGivenUp:
    case EventKind::kLoadFailed:
    case EventKind::kEvicted:
      return becomes(ZoneState::kAbsent);
    default:
      return;
  }
}

void ZoneTable::resync(const ResidentGeneration& resident) {
  for (ZoneId zone = 0; zone < rows_.size(); ++zone) {
    Row& row = rows_[zone];
    row.wanted = false;
    const std::optional<std::uint32_t> generation = resident(zone);
    if (!generation) {
      set_state(zone, ZoneState::kAbsent);
      continue;
    }
    if (row.resident() && row.generation != *generation) mark_changed(zone);
    row.generation = *generation;
    set_state(zone, ZoneState::kResident);
  }
}

void ZoneTable::set_state(ZoneId zone, ZoneState state) noexcept {
  Row& row = rows_[zone];
  const ZoneState before = row.state;
  if (before == state) return;
  row.state = state;
  totals_.filling += is_filling(state) ? 1u : 0u;
  totals_.filling -= is_filling(before) ? 1u : 0u;
  if (state == ZoneState::kResident) {
    ++totals_.resident;
    mark_changed(zone);
  } else if (before == ZoneState::kResident) {
    --totals_.resident;
    mark_changed(zone);
  }
}

void ZoneTable::set_pinned(ZoneId zone, bool pinned) noexcept {
  if (zone >= rows_.size() || rows_[zone].pinned == pinned) return;
  rows_[zone].pinned = pinned;
  totals_.pinned += pinned ? 1u : ~0u;
}

void ZoneTable::add_leases(ZoneId zone, int change) noexcept {
  if (zone >= rows_.size()) return;
  rows_[zone].leases = static_cast<std::uint16_t>(rows_[zone].leases + change);
}

void ZoneTable::mark_changed(ZoneId zone) noexcept {
  Row& row = rows_[zone];
  if (row.changed_at != 0) {
    (row.older == kNoZone ? oldest_ : rows_[row.older].newer) = row.newer;
    (row.newer == kNoZone ? newest_ : rows_[row.newer].older) = row.older;
  }
  row.older = newest_;
  row.newer = kNoZone;
  (newest_ == kNoZone ? oldest_ : rows_[newest_].newer) = zone;
  newest_ = zone;
  row.changed_at = ++counter_;
}

ZoneId ZoneTable::first_changed_after(std::uint64_t since) const noexcept {
  ZoneId first = kNoZone;
  for (ZoneId zone = newest_; zone != kNoZone && rows_[zone].changed_at > since;
       zone = rows_[zone].older) {
    first = zone;
  }
  return first;
}

}  // namespace zonepack
