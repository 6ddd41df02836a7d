// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/lru_shadow.hpp"

namespace zonepack {

LruShadow::LruShadow(std::span<const ZoneNeed> needs, std::uint64_t capacity)
    : needs_(needs),
      capacity_(capacity),
      links_(needs.size()),
      held_(needs.size()),
      order_(links_) {}

std::uint32_t LruShadow::request(ZoneId zone) noexcept {
  const ZoneNeed need = needs_[zone];
  if (held_[zone] != 0) {
    order_.remove(zone, need);
    order_.append(zone, need);
    return 0;
  }
  if (need.slots > capacity_) return 0;
  while (order_.sum().slots + need.slots > capacity_) {
    const ZoneId coldest = order_.coldest();
    order_.remove(coldest, needs_[coldest]);
    held_[coldest] = 0;
  }
  order_.append(zone, need);
  held_[zone] = 1;
  return need.slots;
}

}  // namespace zonepack
