// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"
#include "runtime/memory/eviction_order.hpp"
#include "runtime/memory/slot_pool.hpp"
#include "runtime/memory/zone_list.hpp"
#include "runtime/pack_format/ids.hpp"

namespace zonepack {

enum class ZoneState : std::uint8_t {
  kAbsent,
  kFilling,     // admitted: charged, the loader owns its slots
  kCancelling,  // the loader was asked to give up: still charged until it gives the slots back
  kResident,    // decoded and usable
};

// Why a zone is admitted: only for the robot's own zone are readers' leases revoked.
enum class Purpose : std::uint8_t { kOwnZone, kApproach };

struct ResidencyLimits {
  ByteCount budget = 0;  // everything charged, `fixed` included
  ByteCount fixed = 0;   // charged from the start: tables, manifest, graph, read buffers
  ByteCount slot_bytes = 0;
  std::uint64_t max_signatures = 0;  // the paper's MemoryThr; 0: no such limit
  // The most slots and signatures that any two zones joined by a portal need together: what pins
  // must leave free.
  NeedSum largest_pair;
  std::int64_t lease_ns = 0;               // how long a lease lasts unless released earlier
  std::uint32_t most_slots = kNoSlot - 1;  // that exist, however many the budget allows
};

// A zone that admit() unloaded. Its slots belong to the receiver, who gives them to the SlotPool.
struct Eviction {
  ZoneId zone = kNoZone;
  std::uint32_t generation = 0;
  ZoneNeed need;
  SlotChain slots;
};

// A reader's claim on a resident zone; worthless once the zone's lease epoch has moved on.
struct Lease {
  ZoneId zone = kNoZone;
  std::uint32_t generation = 0;
  std::uint32_t epoch = 0;
};

struct ResidencyCounters {
  std::uint64_t zones_loaded = 0;
  std::uint64_t zones_unloaded = 0;
  std::uint64_t signatures_loaded = 0;
  std::uint64_t signatures_unloaded = 0;
  std::uint64_t loads_given_up = 0;  // cancelled or failed: never usable, so not "loaded"
  std::uint64_t leases_revoked = 0;  // run out, or in the way of the robot's own zone
};

// The zones held in memory, and what is charged for each: least recently used first out, after
// Algorithm 1 of Yun and Yoo, "Semantic Zone based 3D Map Management for Mobile Robot" (arXiv
// 2512.12228), with a hard limit, loads that take time, and nothing evicted for a zone that would
// not fit anyway.
//
// Invariant: charged() <= limits.budget and signatures() <= limits.max_signatures (unless 0),
// before and after every call.
// Invariant: protected, pinned and filling zones are never evicted.
// Invariant: a resident zone is on exactly one list: evictable, leased, or (protected or pinned)
// none; so what could be evicted is a running sum.
// Real-time: no allocation after construction; every call is O(1), admit() O(1) for each zone
// evicted; with an order, plus what that states.
// Threads: owned by the control thread.
class Residency {
 public:
  // order: who is evicted, in place of the least recently used; null: that. Outlives this object.
  Residency(std::size_t zones, const ResidencyLimits& limits, EvictionOrder* order = nullptr);
  Residency(const Residency&) = delete;
  Residency& operator=(const Residency&) = delete;

  // Charges `need` to `zone`, first evicting least recently used zones that nothing protects,
  // coldest first, each passed to on_evicted(const Eviction&); opens a new generation, and the
  // loader fills the zone next. Returns how many were evicted. On error nothing has changed:
  // kTooLarge (would not fit even alone), kNoRoom (does not fit alongside what is protected), kBusy
  // (a cancelled load still holds its slots), kExists (filling or resident already).
  template <typename OnEvicted>
  Result<std::size_t> admit(ZoneId zone, ZoneNeed need, Purpose purpose, OnEvicted&& on_evicted) {
    if (const Result<void> possible = check(zone, need, purpose); !possible)
      return possible.error();
    std::size_t evictions = 0;
    for (; !free().holds(need); ++evictions) on_evicted(evict_next(need));
    open(zone, need);
    return evictions;
  }

  // The loader filled the zone, even if it was asked to give up meanwhile: the zone is resident.
  void complete(ZoneId zone, std::uint32_t generation, SlotChain slots) noexcept;

  // Makes a zone resident that was so where a recorded run continues, as the most recently used.
  // Before the first cycle. kNoRoom, kTooLarge, kExists.
  Result<void> restore(ZoneId zone, ZoneNeed need, std::uint32_t generation) noexcept;

  // The loader gave the slots back, having failed or been cancelled: the zone is absent.
  void give_up(ZoneId zone, std::uint32_t generation) noexcept;

  // Asks for a load to be given up; false when the zone is not filling.
  bool cancel(ZoneId zone) noexcept;

  // A protected zone is not evicted. Any state; kept while the zone comes and goes.
  void protect(ZoneId zone) noexcept;
  void unprotect(ZoneId zone) noexcept;

  // A pinned zone is not evicted, until unpin(). kNoRoom when all pinned zones and the largest
  // neighbouring pair would not fit together.
  Result<void> pin(ZoneId zone, ZoneNeed need) noexcept;
  void unpin(ZoneId zone) noexcept;

  // Charges bytes and slots for something other than a zone (another map on its way in), if they
  // fit without evicting anything; else kNoRoom, and nothing has changed.
  Result<void> set_aside(ByteCount bytes, std::uint32_t slots) noexcept;
  void give_up_set_aside() noexcept;

  // Evicts a resident zone, even a wanted one. kNotFound when it is not.
  Result<Eviction> drop(ZoneId zone) noexcept;

  // Takes a resident zone out without counting it as unloaded: its slots go to another map's
  // memory, by adopt(). kNotFound when it is not resident.
  Result<SlotChain> hand_over(ZoneId zone) noexcept;
  // Makes a zone resident that another map's memory handed over, as the most recently used, without
  // counting it as loaded. The errors of admit(); nothing is evicted.
  Result<void> adopt(ZoneId zone, ZoneNeed need, const SlotChain& slots) noexcept;

  // The zone that would be evicted first; kNoZone when nothing may be. The next one in that order.
  ZoneId coldest() const noexcept { return evictable_.coldest(); }
  ZoneId warmer(ZoneId evictable) const noexcept { return evictable_.warmer(evictable); }

  // Continues another map's counters.
  void continue_counters(const ResidencyCounters& counters) noexcept { counters_ = counters; }

  // While frozen nothing is evicted: admit() returns kNoRoom where it would have to.
  void freeze(bool frozen) noexcept { frozen_ = frozen; }
  bool frozen() const noexcept { return frozen_; }

  // For the order: a cycle begins, and a zone is needed that was not before.
  bool has_order() const noexcept { return order_ != nullptr; }
  void begin_cycle(const EvictionMoment& moment) noexcept;
  void request(ZoneId zone) noexcept {
    if (order_ != nullptr) order_->requested(zone, resident(zone));
  }

  // Whether one candidate for eviction goes before another that is colder.
  bool goes_before(ZoneId zone, ZoneId colder) noexcept {
    return order_ != nullptr && order_->goes_before(zone, colder);
  }

  // Marks a zone as most recently used.
  void touch(ZoneId zone) noexcept;

  // A lease delays evictions made for approached zones until released, run out or revoked.
  // kNotFound when the zone is not resident. A lease also touches the zone, as reading is using.
  Result<Lease> lease(ZoneId zone, std::int64_t now_ns) noexcept;
  void release(const Lease& lease) noexcept;
  void expire_leases(std::int64_t now_ns) noexcept;

  ZoneState state(ZoneId zone) const noexcept { return records_[zone].state; }
  bool resident(ZoneId zone) const noexcept { return state(zone) == ZoneState::kResident; }
  bool pinned(ZoneId zone) const noexcept { return records_[zone].pinned; }
  // What is charged for the zone now; nothing when absent.
  ZoneNeed charge(ZoneId zone) const noexcept;
  // Counts the loads of a zone; a reader compares it before and after.
  std::uint32_t generation(ZoneId zone) const noexcept { return records_[zone].generation; }
  // The slots of a resident zone.
  const SlotChain& slots(ZoneId zone) const noexcept { return records_[zone].slots; }

  std::size_t zone_count() const noexcept { return records_.size(); }
  std::uint32_t slot_count() const noexcept { return slot_count_; }
  ByteCount charged() const noexcept {
    return limits_.fixed + (used_.slots + set_aside_) * limits_.slot_bytes;
  }
  std::uint64_t signatures() const noexcept { return used_.signatures; }
  // What zones are charged for.
  const NeedSum& used_sum() const noexcept { return used_; }
  // Of that, the part that is decoded and usable.
  const NeedSum& resident_sum() const noexcept { return resident_; }
  // What fits without evicting anything.
  NeedSum room() const noexcept { return free(); }
  const ResidencyLimits& limits() const noexcept { return limits_; }
  const ResidencyCounters& counters() const noexcept { return counters_; }
  // Operations on lists and chains so far: each eviction adds the same number.
  std::uint64_t operations() const noexcept;

  // How many slots a budget has room for besides what is fixed.
  static std::uint32_t slots_within(ByteCount budget, ByteCount fixed,
                                    ByteCount slot_bytes) noexcept;
  // What the tables of this class take from the budget.
  static ByteCount table_bytes(std::size_t zones) noexcept;
  // And what they take more with an order.
  static ByteCount order_bytes(std::size_t zones) noexcept { return zones * sizeof(ZoneTimes); }

 private:
  enum class List : std::uint8_t { kNone, kEvictable, kLeased };
  struct Record {
    SlotChain slots;
    ZoneNeed need;
    ZoneNeed pinned_need;
    std::int64_t lease_end_ns = 0;
    std::uint32_t generation = 0;
    std::uint32_t leases = 0;
    std::uint32_t lease_epoch = 0;
    ZoneState state = ZoneState::kAbsent;
    List list = List::kNone;
    bool protected_ = false;
    bool pinned = false;
  };

  Result<void> check(ZoneId zone, ZoneNeed need, Purpose purpose) const noexcept;
  NeedSum free() const noexcept;
  Eviction evict_next(ZoneNeed wanted) noexcept;
  Eviction evict(ZoneId zone) noexcept;
  void open(ZoneId zone, ZoneNeed need) noexcept;
  void fill(Record& record, ZoneId zone, const SlotChain& slots) noexcept;
  void discharge(Record& record) noexcept;
  Eviction take_out(ZoneId zone) noexcept;
  void put_on_list(ZoneId zone) noexcept;
  void take_off_list(ZoneId zone) noexcept;
  void end_leases(ZoneId zone) noexcept;

  ResidencyLimits limits_;
  std::uint32_t paid_slots_;  // within the budget
  std::uint32_t slot_count_;  // of these, that exist
  std::vector<Record> records_;
  std::vector<ZoneLink> links_;
  std::vector<ZoneLink> timer_links_;
  ZoneList evictable_;
  ZoneList leased_;
  ZoneList lease_timers_;  // every leased zone, first to end first: all leases last equally long
  NeedSum used_;
  NeedSum resident_;
  NeedSum pinned_;
  std::uint64_t set_aside_ = 0;        // slots, bytes counted as whole slots
  std::uint64_t set_aside_slots_ = 0;  // of these, real ones
  bool frozen_ = false;
  ResidencyCounters counters_;
  EvictionOrder* order_;
  std::vector<ZoneTimes> times_;  // by ZoneId; empty without an order
  std::int64_t now_ns_ = 0;       // of the cycle; 0 without an order
};

}  // namespace zonepack
