// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/memory/zone_list.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// What a memory of the same size would hold and have loaded, had it always evicted the least
// recently used zone: nothing is loaded for it, only counted. It follows the real requests.
//
// Real-time: no allocation after construction; a request costs O(1), and O(1) for each zone that
// the shadow evicts.
// Threads: owned by the control thread.
class LruShadow {
 public:
  // needs: by ZoneId, outlives this object; capacity: in slots.
  LruShadow(std::span<const ZoneNeed> needs, std::uint64_t capacity);

  // The zone is used from now on. Returns the slots that are loaded for it: 0 when it was held, or
  // is larger than all the memory.
  std::uint32_t request(ZoneId zone) noexcept;

  bool holds(ZoneId zone) const noexcept { return held_[zone]; }
  std::uint64_t capacity() const noexcept { return capacity_; }

  // What its tables take from the budget.
  static ByteCount table_bytes(std::size_t zones) noexcept {
    return zones * (sizeof(ZoneLink) + 1);
  }

 private:
  std::span<const ZoneNeed> needs_;
  std::uint64_t capacity_;
  std::vector<ZoneLink> links_;
  std::vector<std::uint8_t> held_;  // by ZoneId
  ZoneList order_;
};

}  // namespace zonepack
