// SPDX-License-Identifier: Apache-2.0
// Random zones, sizes, routes, pins, leases and cancellations against a model that recounts
// everything.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "runtime/memory/residency.hpp"
#include "runtime/memory/slot_pool.hpp"

namespace zonepack {
namespace {

constexpr ByteCount kSlot = 16384;
constexpr ByteCount kFixed = 5000;

// Drives a Residency and a SlotPool as cycle and loader would, and knows the owner of each slot.
class Driver {
 public:
  explicit Driver(std::uint32_t seed)
      : random_(seed),
        needs_(make_needs()),
        limits_(make_limits()),
        memory_(needs_.size(), limits_),
        pool_(memory_.slot_count()) {}

  void step() {
    now_ns_ += pick(20);
    memory_.expire_leases(now_ns_);
    const auto zone = static_cast<ZoneId>(pick(needs_.size()));
    switch (pick(10)) {
      case 0:
      case 1:
      case 2:
        admit(zone);
        break;
      case 3:
        finish_a_load();
        break;
      case 4:
        if (memory_.cancel(zone)) ++cancelled_;
        break;
      case 5:
        set_protected(zone);
        break;
      case 6:
        if (pick(8) == 0) set_pinned(zone);
        break;
      case 7:
        take_lease(zone);
        break;
      case 8:
        drop_lease();
        break;
      default:
        memory_.touch(zone);
    }
    check();
  }

  std::uint64_t evictions() const { return evictions_; }
  std::uint64_t refusals() const { return refusals_; }

 private:
  std::size_t pick(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

  std::vector<ZoneNeed> make_needs() {
    std::vector<ZoneNeed> needs(2 + pick(30));
    for (ZoneNeed& need : needs) {
      need.slots = static_cast<std::uint32_t>(pick(12));  // 0: a zone without signatures
      need.signatures = need.slots == 0 ? 0 : static_cast<std::uint32_t>(1 + pick(40));
    }
    return needs;
  }

  ResidencyLimits make_limits() {
    return {kFixed + kSlot * (1 + pick(60)), kFixed,   kSlot,
            pick(2) * (1 + pick(200)),       {12, 40}, 100};
  }

  void admit(ZoneId zone) {
    const ByteCount before = memory_.charged();
    const auto purpose = pick(2) == 0 ? Purpose::kOwnZone : Purpose::kApproach;
    const auto result = memory_.admit(zone, needs_[zone], purpose, [&](const Eviction& eviction) {
      ++evictions_;
      EXPECT_FALSE(protected_.count(eviction.zone));
      EXPECT_FALSE(pinned_.count(eviction.zone));
      EXPECT_FALSE(purpose == Purpose::kApproach && leased(eviction.zone));
      EXPECT_EQ(eviction.need, needs_[eviction.zone]);
      SlotChain chain = eviction.slots;
      pool_.give_back(chain);
      held_.erase(eviction.zone);
    });
    if (!result) {
      ++refusals_;
      EXPECT_EQ(memory_.charged(), before);
      return;
    }
    SlotChain chain;
    ASSERT_TRUE(pool_.take(needs_[zone].slots, chain)) << "charged, but no slot is free";
    loading_.push_back({zone, memory_.generation(zone), chain});
    held_[zone] = chain;
  }

  void finish_a_load() {
    if (loading_.empty()) return;
    const std::size_t which = pick(loading_.size());
    Loading load = loading_[which];
    loading_.erase(loading_.begin() + static_cast<std::ptrdiff_t>(which));
    if (pick(3) == 0) {
      pool_.give_back(load.chain);
      held_.erase(load.zone);
      memory_.give_up(load.zone, load.generation);
    } else {
      memory_.complete(load.zone, load.generation, load.chain);
    }
  }

  void set_protected(ZoneId zone) {
    if (protected_.erase(zone) > 0) {
      memory_.unprotect(zone);
    } else {
      memory_.protect(zone);
      protected_.insert(zone);
    }
  }

  void set_pinned(ZoneId zone) {
    if (pinned_.erase(zone) > 0) {
      memory_.unpin(zone);
    } else if (memory_.pin(zone, needs_[zone]).ok()) {
      pinned_.insert(zone);
    }
  }

  void take_lease(ZoneId zone) {
    const auto lease = memory_.lease(zone, now_ns_);
    EXPECT_EQ(lease.ok(), memory_.resident(zone));
    if (lease) leases_.push_back({*lease, now_ns_ + limits_.lease_ns});
  }

  void drop_lease() {
    if (leases_.empty()) return;
    memory_.release(leases_.front().first);
    leases_.erase(leases_.begin());
  }

  // A lease that was neither released nor ran out; a later lease of the same zone prolongs it.
  bool leased(ZoneId zone) const {
    return std::any_of(leases_.begin(), leases_.end(), [&](const auto& held) {
      return held.first.zone == zone && held.first.generation == memory_.generation(zone) &&
             held.second > now_ns_;
    });
  }

  void check() const {
    std::uint64_t slots = 0, signatures = 0;
    std::set<SlotIndex> used;
    for (ZoneId zone = 0; zone < needs_.size(); ++zone) {
      if (memory_.state(zone) == ZoneState::kAbsent) {
        EXPECT_EQ(memory_.charge(zone), ZoneNeed{});
        continue;
      }
      EXPECT_EQ(memory_.charge(zone), needs_[zone]);
      slots += needs_[zone].slots;
      signatures += needs_[zone].signatures;
      for (SlotIndex s = held_.at(zone).head; s != kNoSlot; s = pool_.next(s)) {
        EXPECT_TRUE(used.insert(s).second) << "slot " << s << " belongs to two zones";
      }
    }
    EXPECT_EQ(used.size(), slots);
    EXPECT_EQ(pool_.free_count() + slots, pool_.slot_count());
    EXPECT_EQ(memory_.charged(), kFixed + slots * kSlot);
    EXPECT_LE(memory_.charged(), limits_.budget);
    EXPECT_EQ(memory_.signatures(), signatures);
    if (limits_.max_signatures > 0) {
      EXPECT_LE(signatures, limits_.max_signatures);
    }
    const ResidencyCounters& counters = memory_.counters();
    EXPECT_EQ(counters.signatures_loaded - counters.signatures_unloaded,
              memory_.resident_sum().signatures);
  }

  struct Loading {
    ZoneId zone;
    std::uint32_t generation;
    SlotChain chain;
  };

  std::mt19937 random_;
  std::vector<ZoneNeed> needs_;
  ResidencyLimits limits_;
  Residency memory_;
  SlotPool pool_;
  std::int64_t now_ns_ = 0;
  std::vector<Loading> loading_;
  std::map<ZoneId, SlotChain> held_;
  std::set<ZoneId> protected_, pinned_;
  std::vector<std::pair<Lease, std::int64_t>> leases_;
  std::uint64_t evictions_ = 0, refusals_ = 0, cancelled_ = 0;
};

TEST(ResidencyProperties, HoldAfterEveryStepOfRandomUse) {
  std::uint64_t evictions = 0, refusals = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Driver driver(seed);
    for (int i = 0; i < 400; ++i) {
      driver.step();
      if (testing::Test::HasFailure()) return;
    }
    evictions += driver.evictions();
    refusals += driver.refusals();
  }
  // The driver does reach the cases it is for.
  EXPECT_GT(evictions, 1000u);
  EXPECT_GT(refusals, 1000u);
}

}  // namespace
}  // namespace zonepack
