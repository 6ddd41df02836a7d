// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/shared_reader.hpp"

#include <algorithm>

namespace zonepack {

const char* to_string(ReadStatus status) noexcept {
  switch (status) {
    case ReadStatus::kOk:
      return "ok";
    case ReadStatus::kExpired:
      return "expired";
    case ReadStatus::kAbsent:
      return "absent";
    case ReadStatus::kDamaged:
      break;
  }
  return "damaged";
}

Result<SharedReader> SharedReader::open(std::span<const std::byte> memory) {
  const Result<SharedTables> tables = SharedTables::open(memory);
  if (!tables) return tables.error();
  return SharedReader(*tables);
}

std::uint64_t SharedReader::state_of(ZoneId zone) const noexcept {
  if (zone >= tables_.zone_capacity()) return 0;
  return tables_.zone(zone).state.load(std::memory_order_acquire);
}

bool SharedReader::still_valid(const ZoneGrant& grant) const noexcept {
  std::atomic_thread_fence(std::memory_order_acquire);
  return tables_.zone(grant.zone()).state.load(std::memory_order_relaxed) == grant.state();
}

ReadStatus SharedReader::find(ZoneId zone, std::shared_ptr<const ZoneGrant>& grant) {
  const std::uint64_t state = state_of(zone);
  auto held = std::ranges::find_if(grants_, [&](const Held& h) { return h.grant->zone() == zone; });
  if (held != grants_.end() && held->grant->state() != state) {
    grants_.erase(held);
    held = grants_.end();
  }
  if (state == 0) return ReadStatus::kAbsent;
  if (held == grants_.end()) {
    Result<std::unique_ptr<ZoneGrant>> made = ZoneGrant::make(tables_, zone, state);
    if (!made) {
      return made.error().code == ErrorCode::kCancelled ? ReadStatus::kExpired
                                                        : ReadStatus::kDamaged;
    }
    if (grants_.size() == kMostGrants) {
      grants_.erase(std::ranges::min_element(grants_, {}, &Held::last_used));
    }
    held = grants_.insert(grants_.end(), {std::move(*made), 0});
  }
  held->last_used = ++uses_;
  grant = held->grant;
  return ReadStatus::kOk;
}

}  // namespace zonepack
