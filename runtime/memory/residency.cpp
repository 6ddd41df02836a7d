// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/residency.hpp"

#include <algorithm>
#include <limits>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t signature_limit(const ResidencyLimits& limits) noexcept {
  return limits.max_signatures == 0 ? kUnlimited : limits.max_signatures;
}

}  // namespace

std::uint32_t Residency::slots_within(ByteCount budget, ByteCount fixed,
                                      ByteCount slot_bytes) noexcept {
  if (slot_bytes == 0 || fixed > budget) return 0;
  return static_cast<std::uint32_t>(
      std::min<ByteCount>((budget - fixed) / slot_bytes, kNoSlot - 1));
}

ByteCount Residency::table_bytes(std::size_t zones) noexcept {
  return zones * (sizeof(Record) + 2 * sizeof(ZoneLink));
}

Residency::Residency(std::size_t zones, const ResidencyLimits& limits, EvictionOrder* order)
    : limits_(limits),
      paid_slots_(slots_within(limits.budget, limits.fixed, limits.slot_bytes)),
      slot_count_(std::min(paid_slots_, limits.most_slots)),
      records_(zones),
      links_(zones),
      timer_links_(zones),
      evictable_(links_),
      leased_(links_),
      lease_timers_(timer_links_),
      order_(order),
      times_(order != nullptr ? zones : 0) {
  ZP_REQUIRE(limits.fixed <= limits.budget);
}

NeedSum Residency::free() const noexcept {
  return {std::min(paid_slots_ - set_aside_, slot_count_ - set_aside_slots_) - used_.slots,
          signature_limit(limits_) - used_.signatures};
}

Result<void> Residency::check(ZoneId zone, ZoneNeed need, Purpose purpose) const noexcept {
  const Record& record = records_[zone];
  if (record.state == ZoneState::kCancelling) return ErrorCode::kBusy;
  if (record.state != ZoneState::kAbsent) return ErrorCode::kExists;
  if (!NeedSum{slot_count_, signature_limit(limits_)}.holds(need)) {
    return {ErrorCode::kTooLarge, need.slots};
  }
  // Used and free together make up the limit, so these sums cannot overflow.
  NeedSum available = free();
  if (!frozen_) {
    available.add(evictable_.sum());
    if (purpose == Purpose::kOwnZone) available.add(leased_.sum());
  }
  if (!available.holds(need)) return {ErrorCode::kNoRoom, need.slots};
  return {};
}

Result<void> Residency::set_aside(ByteCount bytes, std::uint32_t slots) noexcept {
  const std::uint64_t all =
      slots + (bytes + limits_.slot_bytes - 1) / std::max<ByteCount>(limits_.slot_bytes, 1);
  const NeedSum now = free();
  if (slots > now.slots || all > paid_slots_ - set_aside_ - used_.slots) {
    return {ErrorCode::kNoRoom, static_cast<std::int64_t>(all)};
  }
  set_aside_ = all;
  set_aside_slots_ = slots;
  return {};
}

void Residency::give_up_set_aside() noexcept { set_aside_ = set_aside_slots_ = 0; }

Result<Eviction> Residency::drop(ZoneId zone) noexcept {
  if (records_[zone].state != ZoneState::kResident) return ErrorCode::kNotFound;
  return evict(zone);
}

void Residency::begin_cycle(const EvictionMoment& moment) noexcept {
  if (order_ == nullptr) return;
  now_ns_ = moment.now_ns;
  order_->begin_cycle(moment);
}

Eviction Residency::evict_next(ZoneNeed wanted) noexcept {
  const ZoneId coldest = evictable_.coldest();
  ZoneId zone = coldest != kNoZone ? coldest : leased_.coldest();
  if (order_ != nullptr && coldest != kNoZone) {
    zone = order_->choose({evictable_, times_, wanted, limits_.slot_bytes});
    ZP_REQUIRE(zone < records_.size() && records_[zone].list == List::kEvictable);
  }
  ZP_REQUIRE(zone != kNoZone);
  return evict(zone);
}

Eviction Residency::evict(ZoneId zone) noexcept {
  ++counters_.zones_unloaded;
  counters_.signatures_unloaded += records_[zone].need.signatures;
  return take_out(zone);
}

Eviction Residency::take_out(ZoneId zone) noexcept {
  Record& record = records_[zone];
  take_off_list(zone);
  end_leases(zone);
  if (order_ != nullptr) order_->removed(zone);
  const Eviction eviction{zone, record.generation, record.need, record.slots};
  resident_.remove(record.need);
  discharge(record);
  return eviction;
}

Result<SlotChain> Residency::hand_over(ZoneId zone) noexcept {
  if (records_[zone].state != ZoneState::kResident) return ErrorCode::kNotFound;
  return take_out(zone).slots;
}

Result<void> Residency::adopt(ZoneId zone, ZoneNeed need, const SlotChain& slots) noexcept {
  if (const auto possible = check(zone, need, Purpose::kApproach); !possible) return possible;
  if (!free().holds(need)) return {ErrorCode::kNoRoom, need.slots};
  open(zone, need);
  fill(records_[zone], zone, slots);
  return {};
}

void Residency::open(ZoneId zone, ZoneNeed need) noexcept {
  Record& record = records_[zone];
  record.need = need;
  record.state = ZoneState::kFilling;
  ++record.generation;
  used_.add(need);
}

void Residency::discharge(Record& record) noexcept {
  used_.remove(record.need);
  record.need = {};
  record.slots = {};
  record.state = ZoneState::kAbsent;
}

void Residency::complete(ZoneId zone, std::uint32_t generation, SlotChain slots) noexcept {
  Record& record = records_[zone];
  ZP_REQUIRE(record.state == ZoneState::kFilling || record.state == ZoneState::kCancelling);
  ZP_REQUIRE(record.generation == generation);
  ++counters_.zones_loaded;
  counters_.signatures_loaded += record.need.signatures;
  fill(record, zone, slots);
}

void Residency::fill(Record& record, ZoneId zone, const SlotChain& slots) noexcept {
  ZP_REQUIRE(record.need.slots == slots.count);
  record.slots = slots;
  record.state = ZoneState::kResident;
  resident_.add(record.need);
  if (order_ != nullptr) {
    times_[zone] = {now_ns_, now_ns_};
    order_->loaded(zone, record.need);
  }
  put_on_list(zone);
}

Result<void> Residency::restore(ZoneId zone, ZoneNeed need, std::uint32_t generation) noexcept {
  if (const auto possible = check(zone, need, Purpose::kApproach); !possible) return possible;
  if (!free().holds(need)) return {ErrorCode::kNoRoom, need.slots};
  open(zone, need);
  records_[zone].generation = generation;
  complete(zone, generation, {0, 0, need.slots});
  return {};
}

void Residency::give_up(ZoneId zone, std::uint32_t generation) noexcept {
  Record& record = records_[zone];
  ZP_REQUIRE(record.state == ZoneState::kFilling || record.state == ZoneState::kCancelling);
  ZP_REQUIRE(record.generation == generation);
  ++counters_.loads_given_up;
  discharge(record);
}

bool Residency::cancel(ZoneId zone) noexcept {
  Record& record = records_[zone];
  if (record.state != ZoneState::kFilling) return false;
  record.state = ZoneState::kCancelling;
  return true;
}

void Residency::protect(ZoneId zone) noexcept {
  Record& record = records_[zone];
  if (record.protected_) return;
  take_off_list(zone);
  record.protected_ = true;
}

void Residency::unprotect(ZoneId zone) noexcept {
  Record& record = records_[zone];
  if (!record.protected_) return;
  record.protected_ = false;
  put_on_list(zone);
}

Result<void> Residency::pin(ZoneId zone, ZoneNeed need) noexcept {
  Record& record = records_[zone];
  if (record.pinned) return {};
  NeedSum together = pinned_;
  together.add(limits_.largest_pair);
  together.add(need);
  if (together.slots > slot_count_ || together.signatures > signature_limit(limits_)) {
    return {ErrorCode::kNoRoom, need.slots};
  }
  take_off_list(zone);
  record.pinned = true;
  record.pinned_need = need;
  pinned_.add(need);
  return {};
}

void Residency::unpin(ZoneId zone) noexcept {
  Record& record = records_[zone];
  if (!record.pinned) return;
  record.pinned = false;
  pinned_.remove(record.pinned_need);
  put_on_list(zone);
}

void Residency::touch(ZoneId zone) noexcept {
  if (records_[zone].list != List::kEvictable) return;
  take_off_list(zone);
  put_on_list(zone);
}

Result<Lease> Residency::lease(ZoneId zone, std::int64_t now_ns) noexcept {
  Record& record = records_[zone];
  if (record.state != ZoneState::kResident) return ErrorCode::kNotFound;
  take_off_list(zone);
  if (record.leases > 0) lease_timers_.remove(zone, {});
  lease_timers_.append(zone, {});
  ++record.leases;
  record.lease_end_ns = now_ns + limits_.lease_ns;
  put_on_list(zone);
  return Lease{zone, record.generation, record.lease_epoch};
}

void Residency::release(const Lease& lease) noexcept {
  Record& record = records_[lease.zone];
  if (record.leases == 0 || record.lease_epoch != lease.epoch) return;
  take_off_list(lease.zone);
  if (--record.leases == 0) lease_timers_.remove(lease.zone, {});
  put_on_list(lease.zone);
}

void Residency::expire_leases(std::int64_t now_ns) noexcept {
  for (;;) {
    const ZoneId zone = lease_timers_.coldest();
    if (zone == kNoZone || records_[zone].lease_end_ns > now_ns) return;
    take_off_list(zone);
    end_leases(zone);
    put_on_list(zone);
  }
}

void Residency::end_leases(ZoneId zone) noexcept {
  Record& record = records_[zone];
  if (record.leases == 0) return;
  counters_.leases_revoked += record.leases;
  record.leases = 0;
  ++record.lease_epoch;
  lease_timers_.remove(zone, {});
}

void Residency::put_on_list(ZoneId zone) noexcept {
  Record& record = records_[zone];
  if (record.state != ZoneState::kResident || record.protected_ || record.pinned) return;
  record.list = record.leases > 0 ? List::kLeased : List::kEvictable;
  (record.list == List::kLeased ? leased_ : evictable_).append(zone, record.need);
  if (order_ == nullptr || record.list == List::kLeased) return;
  times_[zone].used_ns = now_ns_;
  order_->released(zone);
}

void Residency::take_off_list(ZoneId zone) noexcept {
  Record& record = records_[zone];
  if (record.list == List::kNone) return;
  (record.list == List::kLeased ? leased_ : evictable_).remove(zone, record.need);
  if (order_ != nullptr && record.list == List::kEvictable) order_->held(zone);
  record.list = List::kNone;
}

ZoneNeed Residency::charge(ZoneId zone) const noexcept { return records_[zone].need; }

std::uint64_t Residency::operations() const noexcept {
  return evictable_.operations() + leased_.operations() + lease_timers_.operations();
}

}  // namespace zonepack
