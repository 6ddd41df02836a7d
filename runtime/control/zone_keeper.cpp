// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/zone_keeper.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/require.hpp"

namespace zonepack {

ZoneKeeper::ZoneKeeper(Residency& memory, ZoneLoader& loader, EventStamper& events,
                       std::span<const ZoneNeed> needs, std::span<const ZoneId> pinned,
                       ZoneDirectory* directory, const ZoneKeeperSettings& settings)
    : memory_(memory),
      loader_(loader),
      events_(events),
      needs_(needs),
      most_pins_(pinned.size() + kMostPins),
      directory_(directory),
      settings_(settings),
      retries_(needs.size()) {
  ZP_REQUIRE(memory.zone_count() == needs.size());
  pinned_.reserve(most_pins_);
  pinned_.assign(pinned.begin(), pinned.end());
}

void ZoneKeeper::collect(std::int64_t now_ns, std::span<const LoadResult> loads) noexcept {
  for (const LoadResult& result : loads) {
    ZP_REQUIRE(result.zone == loading_);
    loading_ = kNoZone;
    if (result.error.code == ErrorCode::kOk) {
      memory_.complete(result.zone, result.generation, result.slots);
      if (directory_ != nullptr) directory_->publish(result.zone, result.generation, result.slots);
      retries_[result.zone] = {};
      emit(EventKind::kLoadDone, result.zone);
    } else {
      memory_.give_up(result.zone, result.generation);
      if (result.error.code == ErrorCode::kCancelled) {
        emit(EventKind::kLoadGivenUp, result.zone);
      } else {
        fail(result.zone, result.error.code, now_ns);
      }
    }
  }
  memory_.expire_leases(now_ns);
}

Result<void> ZoneKeeper::pin(ZoneId zone) noexcept {
  if (memory_.pinned(zone)) return {};
  if (pinned_.size() == most_pins_) return {ErrorCode::kNoRoom, needs_[zone].slots};
  if (const auto accepted = memory_.pin(zone, needs_[zone]); !accepted) return accepted;
  pinned_.push_back(zone);
  return {};
}

void ZoneKeeper::unpin(ZoneId zone) noexcept {
  if (!memory_.pinned(zone)) return;
  memory_.unpin(zone);
  std::erase(pinned_, zone);
}

void ZoneKeeper::fail(ZoneId zone, ErrorCode code, std::int64_t now_ns) noexcept {
  Retry& retry = retries_[zone];
  std::int64_t wait_ns = settings_.first_retry_ns;
  for (std::uint32_t i = 0; i < retry.failures && wait_ns < settings_.last_retry_ns; ++i) {
    wait_ns *= 2;
  }
  ++retry.failures;
  retry.not_before_ns = now_ns + std::min(wait_ns, settings_.last_retry_ns);
  emit(EventKind::kLoadFailed, zone, to_string(code));
}

ZoneKeeper::Demand ZoneKeeper::demand_of(std::size_t place, const Wishes& wishes) noexcept {
  if (place == 0 && wishes.with_own) return Demand::kOwn;
  if (place < wishes.urgent) return Demand::kUrgent;
  if (place < wishes.needed) return Demand::kPossible;
  return Demand::kUseful;
}

void ZoneKeeper::keep(std::int64_t now_ns, const Wishes& wishes) noexcept {
  const std::span<const ZoneId> wanted = wishes.zones;
  ZP_REQUIRE(wanted.size() <= kMaxWanted);
  drop_unwanted(wanted, std::min(wishes.needed, wanted.size()));
  does_not_fit_ = kNoZone;
  for (std::size_t place = 0; place < std::min(wishes.useful, wanted.size()); ++place) {
    see_to(place, wishes, now_ns);
  }
  see_to_likely(wishes, now_ns);
  keep_pinned(now_ns);
  set_blocked(does_not_fit_);
  std::copy(wanted.begin(), wanted.end(), wanted_.begin());
  wanted_count_ = wanted.size();
  needed_count_ = std::min(wishes.needed, wanted.size());
}

bool ZoneKeeper::wants(std::span<const ZoneId> list, ZoneId zone) const noexcept {
  return std::find(list.begin(), list.end(), zone) != list.end();
}

void ZoneKeeper::drop_unwanted(std::span<const ZoneId> wanted, std::size_t needed) noexcept {
  // The most urgent last, which leaves it the warmest.
  for (std::size_t i = wanted_count_; i-- > 0;) {
    const ZoneId zone = wanted_[i];
    if (wants(wanted, zone)) continue;
    memory_.unprotect(zone);
    emit(EventKind::kZoneUnwanted, zone);
  }
  for (const ZoneId zone : wanted) {
    if (!wants({wanted_.data(), wanted_count_}, zone)) emit(EventKind::kZoneWanted, zone);
  }
  for (const ZoneId zone : wanted.first(needed)) {
    if (!wants({wanted_.data(), needed_count_}, zone)) memory_.request(zone);
  }
  if (loading_ != kNoZone && !wants(wanted, loading_) && !memory_.pinned(loading_)) cancel_load();
}

void ZoneKeeper::see_to(std::size_t place, const Wishes& wishes, std::int64_t now_ns) noexcept {
  const std::span<const ZoneId> wanted = wishes.zones;
  const ZoneId zone = wanted[place];
  const Demand demand = demand_of(place, wishes);
  if (zone == loading_) loads_useful_ = demand == Demand::kUseful;
  memory_.protect(zone);
  if (memory_.state(zone) != ZoneState::kAbsent || !may_start(zone, demand, now_ns)) return;
  const Purpose purpose = demand == Demand::kOwn ? Purpose::kOwnZone : Purpose::kApproach;
  bool admitted = admit(zone, purpose).ok();
  if (!admitted && demand != Demand::kPossible) {
    for (std::size_t i = wanted.size(); --i > place;) memory_.unprotect(wanted[i]);
    admitted = admit(zone, purpose).ok();
  }
  if (admitted) {
    loads_useful_ = demand == Demand::kUseful;
  } else if (does_not_fit_ == kNoZone && demand > Demand::kUseful) {
    does_not_fit_ = zone;
  }
}

// Likely zones are not protected: what is needed takes their room as it takes that of any other.
void ZoneKeeper::see_to_likely(const Wishes& wishes, std::int64_t now_ns) noexcept {
  const std::span<const ZoneId> likely =
      wishes.zones.subspan(std::min(wishes.useful, wishes.zones.size()));
  for (const ZoneId zone : likely) memory_.unprotect(zone);  // it may have been needed
  if (likely.empty()) return;
  if (std::exchange(tried_by_, wishes.foresight->looks()) != wishes.foresight->looks()) {
    tried_count_ = 0;
  }
  const auto was_tried = [this](ZoneId zone) { return wants({tried_.data(), tried_count_}, zone); };
  const std::size_t due = wishes.due - std::min(wishes.due, wishes.useful);
  for (std::size_t i = 0; i < likely.size(); ++i) {
    const ZoneId zone = likely[i];
    if (zone == loading_) loads_useful_ = !wishes.sure;
    if (loading_ != kNoZone || memory_.state(zone) != ZoneState::kAbsent) continue;
    if (!wishes.sure && (was_tried(zone) || !would_stay(zone, wishes))) continue;
    if (may_start(zone, Demand::kLikely, now_ns) &&
        (i < due ? make_colder_room(zone, *wishes.foresight)
                 : memory_.room().holds(needs_[zone])) &&
        admit(zone, Purpose::kApproach)) {
      loads_useful_ = !wishes.sure;
      if (tried_count_ < tried_.size()) tried_[tried_count_++] = zone;
    } else if (wishes.sure) {
      return;
    }
  }
}

// Whether the zone would still be there when the robot enters it: not where a zone that it enters
// before, and more surely, cannot be in memory with it and the robot's own.
bool ZoneKeeper::would_stay(ZoneId zone, const Wishes& wishes) const noexcept {
  const std::span<const Coming> coming = wishes.foresight->coming();
  const auto listed = std::ranges::find(coming, zone, &Coming::zone);
  if (listed == coming.end()) return true;
  NeedSum all = memory_.room();
  all.add(memory_.used_sum());
  const auto fits = [&](ZoneId between) {
    NeedSum sum;
    sum.add(needs_[zone]);
    sum.add(needs_[between]);
    if (wishes.with_own && !wishes.zones.empty()) sum.add(needs_[wishes.zones.front()]);
    return sum.slots <= all.slots && sum.signatures <= all.signatures;
  };
  return std::ranges::all_of(coming, [&](const Coming& other) {
    return other.zone == zone || other.seconds >= listed->seconds || other.share < listed->share ||
           fits(other.zone);
  });
}

// Whether the zone fits, if need be once zones are evicted that are worth less: the least worth
// first, and none of them unless they are enough. Of zones worth the same, the one that would be
// evicted first anyway.
bool ZoneKeeper::make_colder_room(ZoneId zone, const Foresight& foresight) noexcept {
  struct Colder {
    ZoneId zone;
    float worth;
  };
  std::array<Colder, kMostColder> colder;
  std::size_t count = 0;
  NeedSum room = memory_.room();
  const ZoneNeed need = needs_[zone];
  if (!room.holds(need) && !memory_.frozen()) {
    const float worth = foresight.worth(zone);
    for (ZoneId other = memory_.coldest(); other != kNoZone && count < colder.size();
         other = memory_.warmer(other)) {
      const Colder one{other, foresight.worth(other)};
      if (one.worth < worth) colder[count++] = one;
    }
  }
  std::size_t taken = 0;
  for (; !room.holds(need) && taken < count; ++taken) {
    std::size_t least = taken;
    for (std::size_t i = taken + 1; i < count; ++i) {
      const Colder &a = colder[i], &b = colder[least];
      if (a.worth != b.worth ? a.worth < b.worth : memory_.goes_before(a.zone, b.zone)) least = i;
    }
    // The others keep their places, so that the coldest comes first among equals.
    std::rotate(colder.begin() + static_cast<std::ptrdiff_t>(taken),
                colder.begin() + static_cast<std::ptrdiff_t>(least),
                colder.begin() + static_cast<std::ptrdiff_t>(least) + 1);
    room.add(needs_[colder[taken].zone]);
  }
  if (!room.holds(need)) return false;
  for (std::size_t i = 0; i < taken; ++i) drop(colder[i].zone);
  return true;
}

bool ZoneKeeper::may_start(ZoneId zone, Demand demand, std::int64_t now_ns) noexcept {
  if (held_) return false;
  if (now_ns < retries_[zone].not_before_ns) return false;
  if (loading_ == kNoZone) return true;
  if (demand == Demand::kOwn || (loads_useful_ && demand > Demand::kUseful)) cancel_load();
  return false;
}

void ZoneKeeper::keep_pinned(std::int64_t now_ns) noexcept {
  for (const ZoneId zone : pinned_) {
    if (zone == loading_) loads_useful_ = false;
    if (memory_.state(zone) != ZoneState::kAbsent) continue;
    if (!may_start(zone, Demand::kPossible, now_ns)) continue;
    if (admit(zone, Purpose::kApproach)) {
      loads_useful_ = false;
    } else if (does_not_fit_ == kNoZone) {
      does_not_fit_ = zone;
    }
  }
}

Result<std::size_t> ZoneKeeper::admit(ZoneId zone, Purpose purpose) noexcept {
  const auto result = memory_.admit(zone, needs_[zone], purpose, [this](const Eviction& evicted) {
    if (directory_ != nullptr) directory_->withdraw(evicted.zone);
    loader_.take_back(evicted.slots);
    emit(EventKind::kEvicted, evicted.zone);
  });
  if (result) {
    loading_ = zone;
    loader_.load({zone, memory_.generation(zone), needs_[zone].slots});
    emit(EventKind::kLoadStarted, zone);
  }
  return result;
}

bool ZoneKeeper::drop(ZoneId zone) noexcept {
  const auto evicted = memory_.drop(zone);
  if (!evicted) return false;
  if (directory_ != nullptr) directory_->withdraw(zone);
  loader_.take_back(evicted->slots);
  emit(EventKind::kEvicted, zone);
  return true;
}

void ZoneKeeper::take_over(ZoneId zone, const SlotChain& slots) noexcept {
  const auto admitted =
      memory_.admit(zone, needs_[zone], Purpose::kOwnZone, [](const Eviction&) {});
  ZP_REQUIRE(admitted && *admitted == 0);
  emit(EventKind::kLoadStarted, zone);
  memory_.complete(zone, memory_.generation(zone), slots);
  if (directory_ != nullptr) directory_->publish(zone, memory_.generation(zone), slots);
  emit(EventKind::kLoadDone, zone);
}

SlotChain ZoneKeeper::hand_over(ZoneId zone) noexcept {
  const auto slots = memory_.hand_over(zone);
  ZP_REQUIRE(slots.ok());
  if (directory_ != nullptr) directory_->withdraw(zone);
  return *slots;
}

void ZoneKeeper::adopt(ZoneId zone, const SlotChain& slots) noexcept {
  const auto adopted = memory_.adopt(zone, needs_[zone], slots);
  ZP_REQUIRE(adopted.ok());
  if (directory_ != nullptr) directory_->publish(zone, memory_.generation(zone), slots);
  emit(EventKind::kZoneKept, zone);
}

void ZoneKeeper::cancel_load() noexcept {
  if (!memory_.cancel(loading_)) return;
  loader_.cancel();
  emit(EventKind::kLoadCancelled, loading_);
}

void ZoneKeeper::set_blocked(ZoneId zone) noexcept {
  if (zone == blocked_) return;
  if (zone != kNoZone) {
    emit(EventKind::kBlocked, zone);
  } else {
    emit(EventKind::kUnblocked, blocked_);
  }
  blocked_ = zone;
}

void ZoneKeeper::emit(EventKind kind, ZoneId zone, const char* reason) noexcept {
  Event event;
  event.kind = kind;
  event.zone = zone;
  event.generation = memory_.generation(zone);
  event.signatures = needs_[zone].signatures;
  event.bytes = needs_[zone].slots * memory_.limits().slot_bytes;
  event.charged_signatures = memory_.signatures();
  event.charged_bytes = memory_.charged();
  event.reason = reason;
  events_.emit(event);
}

}  // namespace zonepack
