// SPDX-License-Identifier: Apache-2.0
#include "runtime/control/map_switcher.hpp"

#include <algorithm>
#include <utility>

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

constexpr double kNear_m = 3;
constexpr int kLookAtMost = 256;  // zones examined in a cycle for one to evict

}  // namespace

bool MapSwitcher::offer(MapInUse& next) noexcept {
  if (next_ != nullptr || unused_ != nullptr) return false;
  next_ = &next;
  return true;
}

const CycleState& MapSwitcher::run(const CycleInput& input) noexcept {
  CycleInput own = input;
  const LoadResult* answer = nullptr;
  if (step_ == Step::kLoading && !input.loads.empty()) {
    ZP_REQUIRE(input.loads.size() == 1);
    answer = &input.loads[0];
    own.loads = {};
  }
  for (const Command& command : input.commands) {
    if (command.kind == Command::Kind::kMapFreed) map_->memory.give_up_set_aside();
  }
  map_->cycle.run(own);
  if (input.offer.map != 0) keeping_ = input.offer.keeps;
  if (input.offer.fault != ErrorCode::kOk) {
    map_->cycle.report(EventKind::kMapOffered);
    map_->cycle.report(EventKind::kMapRefused, to_string(input.offer.fault));
  }
  if (answer != nullptr) {
    take_load(*answer);
  } else if (next_ != nullptr && step_ == Step::kNone) {
    begin(input.now_ns);
  }
  if (step_ == Step::kMakingRoom) make_room();
  if (step_ != Step::kNone && input.now_ns - begun_ns_ > kMostWait_ns) loader_.cancel();
  return map_->cycle.state();
}

void MapSwitcher::begin(std::int64_t now_ns) noexcept {
  map_->cycle.report(EventKind::kMapOffered);
  if (map_->memory.frozen()) {
    refuse("frozen");
    return;
  }
  begun_ns_ = now_ns;
  looked_at_ = 0;
  own_ = map_->cycle.state().zone;
  kept_count_ = 0;
  zone_ = kNoZone;
  const PoseEstimate& pose = map_->cycle.state().pose;
  if (pose.valid) {
    zone_ = next_->graph.zone_near({pose.T_map_base.x_m, pose.T_map_base.y_m}, kNear_m);
    if (zone_ != kNoZone && !next_->graph.loadable(zone_)) zone_ = kNoZone;
  }
  map_->cycle.keeper().hold(true);
  step_ = Step::kMakingRoom;
}

void MapSwitcher::make_room() noexcept {
  if (map_->cycle.keeper().loading() || drop_one()) return;
  loads_ = zone_ != kNoZone && !keeps_twin(zone_);
  const ZoneNeed need = loads_ ? next_->needs[zone_] : ZoneNeed{};
  if (!room_for(need)) {
    map_->memory.give_up_set_aside();
    next_->memory.give_up_set_aside();
    if (!drop_kept()) refuse("no room");
    return;
  }
  next_->memory.give_up_set_aside();
  if (!loads_) {
    change({});
    return;
  }
  loader_.use(next_->catalog);
  loader_.load({zone_, 1, need.slots});
  step_ = Step::kLoading;
}

// This budget must hold the new map's tables and zone, the other one the old map's tables as well,
// each besides the zones that are kept.
bool MapSwitcher::room_for(ZoneNeed need) noexcept {
  NeedSum all;
  all.add(need);
  for (const ZoneId zone : kept()) all.add(map_->needs[zone]);
  const std::uint64_t most = next_->memory.limits().max_signatures;
  if (kept_count_ > 0 && most > 0 && all.signatures > most) return false;
  if (all.slots > next_->slots) return false;
  return map_->memory.used_sum().slots + need.slots <= next_->slots &&
         map_->memory.set_aside(next_->memory.limits().fixed, need.slots) &&
         next_->memory.set_aside(map_->memory.limits().fixed,
                                 static_cast<std::uint32_t>(all.slots));
}

// True while there may be more to evict.
bool MapSwitcher::drop_one() noexcept {
  constexpr int kMostCompared = 16;  // names and digests in a cycle
  const auto zones = static_cast<ZoneId>(map_->needs.size());
  int compared = 0;
  for (int looked = 0; looked < kLookAtMost && looked_at_ < zones; ++looked) {
    const ZoneId zone = looked_at_++;
    if (keeping_ && map_->memory.resident(zone)) {
      if (keeps(zone)) {
        if (++compared == kMostCompared) return true;
        continue;
      }
    }
    if (zone != own_ && map_->cycle.keeper().drop(zone)) return true;
  }
  return looked_at_ < zones;
}

// The zone of the next map that is this one of the map in use, byte for byte; kNoZone: none.
ZoneId MapSwitcher::twin_of(ZoneId zone) const noexcept {
  const CatalogZone& here = map_->catalog.zones[zone];
  if (map_->catalog.payload != next_->catalog.payload) return kNoZone;
  const ZoneId twin = next_->catalog.find(here.name);
  if (twin == kNoZone || next_->catalog.zones[twin].pack_digest != here.pack_digest ||
      next_->needs[twin] != map_->needs[zone]) {
    return kNoZone;
  }
  return twin;
}

bool MapSwitcher::keeps(ZoneId zone) noexcept {
  if (kept_count_ == kept_zones_.size() || twin_of(zone) == kNoZone) return false;
  kept_zones_[kept_count_++] = zone;
  return true;
}

bool MapSwitcher::keeps_twin(ZoneId of_next) const noexcept {
  return std::ranges::any_of(kept(), [&](ZoneId zone) { return twin_of(zone) == of_next; });
}

// Evicts the one that was used least recently, but the robot's own last. False when none is left.
bool MapSwitcher::drop_kept() noexcept {
  if (kept_count_ == 0) return false;
  ZoneId zone = map_->memory.coldest();
  while (zone != kNoZone && !std::ranges::binary_search(kept(), zone)) {
    zone = map_->memory.warmer(zone);
  }
  if (zone == kNoZone) {
    const auto other = std::ranges::find_if(kept(), [&](ZoneId one) { return one != own_; });
    zone = other == kept().end() ? own_ : *other;
  }
  const auto end = kept_zones_.begin() + static_cast<std::ptrdiff_t>(kept_count_);
  std::copy(std::find(kept_zones_.begin(), end, zone) + 1, end,
            std::find(kept_zones_.begin(), end, zone));
  --kept_count_;
  // The robot's own is served until the change, as one that changed would be.
  if (zone != own_) map_->cycle.keeper().drop(zone);
  return true;
}

void MapSwitcher::take_load(const LoadResult& result) noexcept {
  ZP_REQUIRE(result.zone == zone_);
  if (result.error.code != ErrorCode::kOk) {
    refuse(to_string(result.error.code));
    return;
  }
  change(result.slots);
}

// Least recently used first, so that they are so in the next map too. What nothing may evict, the
// zones that the robot wants, was used last.
void MapSwitcher::hand_over_kept() noexcept {
  std::size_t count = 0;
  const auto hand_over = [&](ZoneId zone) {
    const ZoneId twin = twin_of(zone);
    handed_over_[count++] = {twin, map_->cycle.keeper().hand_over(zone)};
  };
  for (ZoneId zone = map_->memory.coldest(); zone != kNoZone;) {
    const ZoneId next = map_->memory.warmer(zone);
    if (std::ranges::binary_search(kept(), zone)) hand_over(zone);
    zone = next;
  }
  for (const ZoneId zone : kept()) {
    if (map_->memory.resident(zone)) hand_over(zone);
  }
  ZP_REQUIRE(count == kept_count_);
}

void MapSwitcher::change(const SlotChain& slots) noexcept {
  hand_over_kept();
  // The slots of what is left go back before the new map counts them as free.
  if (own_ != kNoZone) map_->cycle.keeper().drop(own_);
  if (directory_ != nullptr) {
    const auto begun = directory_->begin_map(static_cast<std::uint32_t>(next_->needs.size()));
    ZP_REQUIRE(begun.ok());
  }
  loader_.use(next_->catalog);
  next_->memory.continue_counters(map_->memory.counters());
  const auto tables = next_->memory.set_aside(map_->memory.limits().fixed, 0);
  ZP_REQUIRE(tables.ok());
  next_->cycle.go_on_from(map_->cycle);
  next_->cycle.report(EventKind::kMapChanged);
  for (std::size_t i = 0; i < kept_count_; ++i) {
    next_->cycle.keeper().adopt(handed_over_[i].zone, handed_over_[i].slots);
  }
  if (loads_) next_->cycle.keeper().take_over(zone_, slots);
  unused_ = std::exchange(map_, std::exchange(next_, nullptr));
  step_ = Step::kNone;
}

void MapSwitcher::refuse(const char* reason) noexcept {
  map_->memory.give_up_set_aside();
  loader_.use(map_->catalog);
  map_->cycle.keeper().hold(false);
  map_->cycle.report(EventKind::kMapRefused, reason);
  unused_ = std::exchange(next_, nullptr);
  step_ = Step::kNone;
}

}  // namespace zonepack
