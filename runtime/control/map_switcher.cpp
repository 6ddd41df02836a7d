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
  kept_ = map_->cycle.state().zone;
  zone_ = kNoZone;
  const PoseEstimate& pose = map_->cycle.state().pose;
  if (pose.valid) {
    zone_ = next_->graph.zone_near({pose.T_map_base.x_m, pose.T_map_base.y_m}, kNear_m);
  }
  map_->cycle.keeper().hold(true);
  step_ = Step::kMakingRoom;
}

void MapSwitcher::make_room() noexcept {
  if (map_->cycle.keeper().loading() || drop_one()) return;
  const ZoneNeed need = zone_ == kNoZone ? ZoneNeed{} : next_->needs[zone_];
  // This budget must hold the new map's tables and zone, the other one the old map's tables as
  // well.
  const bool room = map_->memory.used_sum().slots + need.slots <= next_->slots &&
                    map_->memory.set_aside(next_->memory.limits().fixed, need.slots) &&
                    next_->memory.set_aside(map_->memory.limits().fixed, need.slots);
  if (!room) {
    refuse("no room");
    return;
  }
  next_->memory.give_up_set_aside();
  if (zone_ == kNoZone) {
    change({});
    return;
  }
  loader_.use(next_->catalog);
  loader_.load({zone_, 1, need.slots});
  step_ = Step::kLoading;
}

// True while there may be more to evict.
bool MapSwitcher::drop_one() noexcept {
  const auto zones = static_cast<ZoneId>(map_->needs.size());
  for (int looked = 0; looked < kLookAtMost && looked_at_ < zones; ++looked) {
    const ZoneId zone = looked_at_++;
    if (zone != kept_ && map_->cycle.keeper().drop(zone)) return true;
  }
  return looked_at_ < zones;
}

void MapSwitcher::take_load(const LoadResult& result) noexcept {
  ZP_REQUIRE(result.zone == zone_);
  if (result.error.code != ErrorCode::kOk) {
    refuse(to_string(result.error.code));
    return;
  }
  change(result.slots);
}

void MapSwitcher::change(const SlotChain& slots) noexcept {
  // The slots of what is left go back before the new map counts them as free.
  if (kept_ != kNoZone) map_->cycle.keeper().drop(kept_);
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
  if (zone_ != kNoZone) next_->cycle.keeper().take_over(zone_, slots);
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
