// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "platform/base/byte_count.hpp"
#include "runtime/memory/zone_list.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

class Transitions;

// Where the robot is when a zone may have to go: the same for all decisions of a cycle.
struct EvictionMoment {
  std::int64_t now_ns = 0;
  ZoneId zone = kNoZone;            // the robot's own
  ZoneId zone_before = kNoZone;     // the one that it came from
  std::span<const ZoneId> ahead{};  // zones of the route after `zone`; empty: none or off it
};

// When a zone was held and used; times as EvictionMoment's.
struct ZoneTimes {
  std::int64_t loaded_ns = 0;  // became resident
  std::int64_t used_ns = 0;    // was last wanted, leased or touched
};

// The zones of which one is to be evicted: resident, and neither wanted, pinned nor leased. At
// least one.
// Real-time: every call is O(1).
class EvictionCandidates {
 public:
  EvictionCandidates(const ZoneList& list, std::span<const ZoneTimes> times, ZoneNeed wanted,
                     ByteCount slot_bytes) noexcept
      : list_(list), times_(times), wanted_(wanted), slot_bytes_(slot_bytes) {}

  // From least to most recently used; kNoZone after the last.
  ZoneId coldest() const noexcept { return list_.coldest(); }
  ZoneId warmer(ZoneId candidate) const noexcept { return list_.warmer(candidate); }

  const ZoneTimes& times(ZoneId zone) const noexcept { return times_[zone]; }
  // What all of them together take, and what has to fit in the end.
  const NeedSum& sum() const noexcept { return list_.sum(); }
  ZoneNeed wanted() const noexcept { return wanted_; }
  // Bytes charged for a slot.
  ByteCount slot_bytes() const noexcept { return slot_bytes_; }

 private:
  const ZoneList& list_;
  std::span<const ZoneTimes> times_;
  ZoneNeed wanted_;
  ByteCount slot_bytes_;
};

// Which zone is evicted next, in place of the least recently used one. Residency reports what
// happens to zones in the order in which it happens; without an order it keeps none of this.
//
// Invariant: choose() returns one of the candidates. What protects a zone protects it from every
// order.
// Real-time: no allocation after construction, no exception; each call takes a number of steps that
// the order states.
// Threads: owned by the control thread.
class EvictionOrder {
 public:
  virtual ~EvictionOrder() = default;

  virtual void begin_cycle(const EvictionMoment& /*moment*/) noexcept {}
  // The zone is needed from now on and was not before, when it may have been likely: a hit when it
  // is resident, else a miss.
  virtual void requested(ZoneId /*zone*/, bool /*resident*/) noexcept {}
  // The zone became resident.
  virtual void loaded(ZoneId /*zone*/, ZoneNeed /*need*/) noexcept {}
  // A resident zone is a candidate from now on, as the most recently used one; or is no more.
  virtual void released(ZoneId /*zone*/) noexcept {}
  virtual void held(ZoneId /*zone*/) noexcept {}
  // The zone is no longer resident: it was chosen, dropped, or given to another map.
  virtual void removed(ZoneId /*zone*/) noexcept {}

  virtual ZoneId choose(const EvictionCandidates& candidates) noexcept = 0;

  // Whether one candidate would go before another that is colder.
  virtual bool goes_before(ZoneId /*zone*/, ZoneId /*colder*/) noexcept { return false; }
};

// What an order is made for.
struct EvictionPlace {
  std::span<const ZoneNeed> needs;  // by ZoneId; outlives the order
  std::uint64_t slots = 0;          // within the budget
  // What is known of the robot's habits, if it is held; outlives the order.
  const Transitions* transitions = nullptr;
};
// Null: least recently used, without the cost of an order.
using EvictionOrderMaker = std::function<std::unique_ptr<EvictionOrder>(const EvictionPlace&)>;

}  // namespace zonepack
