// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "platform/base/require.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

// What a zone takes while it is held: slots of the arena and signatures.
struct ZoneNeed {
  std::uint32_t slots = 0;
  std::uint32_t signatures = 0;
  friend bool operator==(const ZoneNeed&, const ZoneNeed&) = default;
};

// A sum of needs that cannot overflow: at most 2^32 zones of 2^32 each.
struct NeedSum {
  std::uint64_t slots = 0;
  std::uint64_t signatures = 0;
  void add(ZoneNeed need) noexcept {
    slots += need.slots;
    signatures += need.signatures;
  }
  void add(const NeedSum& other) noexcept {
    slots += other.slots;
    signatures += other.signatures;
  }
  void remove(ZoneNeed need) noexcept {
    ZP_REQUIRE(slots >= need.slots && signatures >= need.signatures);
    slots -= need.slots;
    signatures -= need.signatures;
  }
  // Whether this is room enough.
  bool holds(ZoneNeed need) const noexcept {
    return need.slots <= slots && need.signatures <= signatures;
  }
  friend bool operator==(const NeedSum&, const NeedSum&) = default;
};

// One zone's place in a ZoneList, kept in an array by ZoneId so that no list operation allocates.
struct ZoneLink {
  ZoneId colder = kNoZone;
  ZoneId warmer = kNoZone;
};

// Zones from least to most recently used, with the sum of what they take. Every operation is O(1)
// and is counted, so that a test can show it.
class ZoneList {
 public:
  explicit ZoneList(std::span<ZoneLink> links) noexcept : links_(links) {}

  ZoneId coldest() const noexcept { return coldest_; }
  ZoneId warmer(ZoneId zone) const noexcept { return links_[zone].warmer; }
  const NeedSum& sum() const noexcept { return sum_; }
  std::uint64_t operations() const noexcept { return operations_; }

  // Puts a zone that is on no list at the warm end.
  void append(ZoneId zone, ZoneNeed need) noexcept {
    ++operations_;
    links_[zone] = {warmest_, kNoZone};
    (warmest_ == kNoZone ? coldest_ : links_[warmest_].warmer) = zone;
    warmest_ = zone;
    sum_.add(need);
  }

  // Takes off a zone that is on this list.
  void remove(ZoneId zone, ZoneNeed need) noexcept {
    ++operations_;
    const ZoneLink link = links_[zone];
    (link.colder == kNoZone ? coldest_ : links_[link.colder].warmer) = link.warmer;
    (link.warmer == kNoZone ? warmest_ : links_[link.warmer].colder) = link.colder;
    links_[zone] = {};
    sum_.remove(need);
  }

 private:
  std::span<ZoneLink> links_;
  ZoneId coldest_ = kNoZone;
  ZoneId warmest_ = kNoZone;
  NeedSum sum_;
  std::uint64_t operations_ = 0;
};

}  // namespace zonepack
