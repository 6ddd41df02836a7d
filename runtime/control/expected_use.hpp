// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "runtime/control/command.hpp"
#include "runtime/memory/eviction_order.hpp"
#include "runtime/memory/lru_shadow.hpp"
#include "runtime/zones/transitions.hpp"
#include "runtime/zones/use_forecast.hpp"

namespace zonepack {

// Evicts the zone that is expected to be used last: by the route, if the robot has one, and else by
// where it went from here on its drives so far. This is Belady's rule (evict what is used farthest
// ahead), "A study of replacement algorithms for a virtual-storage computer" (IBM Systems Journal
// 1966), with a forecast in place of the future. Of zones with equal forecasts the least recently
// used goes; so without any forecast this is that order.
//
// A forecast can be wrong: habits change. So it is watched. What a memory in least recently used
// order would have loaded by now is counted along (LruShadow); when the forecast has cost more than
// kMostLoss of the memory's size over it, that order is followed, beginning with the zones that the
// shadow does not hold, until the loss is made good. Credit for earlier gains is at most
// kMostCredit. So from any moment on, until the shadow is followed, the zones loaded because of a
// wrong forecast are at most kMostLoss + kMostCredit of the memory, plus the one under way.
//
// Real-time: no allocation after construction. choose() looks at the kMostLooks coldest candidates,
// and does what is left of the forecast, which has a fixed bound; begin_cycle() a small part of it.
class ExpectedUse final : public EvictionOrder {
 public:
  static constexpr int kMostLooks = 64;
  static constexpr double kMostLoss = 0.2;    // of the memory
  static constexpr double kMostCredit = 0.5;  // likewise

  // A place with transitions.
  explicit ExpectedUse(const EvictionPlace& place);

  void begin_cycle(const EvictionMoment& moment) noexcept override;
  void requested(ZoneId zone, bool resident) noexcept override;
  void loaded(ZoneId zone, ZoneNeed need) noexcept override;
  ZoneId choose(const EvictionCandidates& candidates) noexcept override;
  bool goes_before(ZoneId zone, ZoneId colder) noexcept override;

  // The forecast did worse than the least recently used order, which is followed.

  // What it takes from the budget: the same on every processor, as the decisions are.
  static constexpr ByteCount kOwnBytes = ByteCount{12} * 1024;
  static ByteCount table_bytes(std::size_t zones) noexcept {
    return kOwnBytes + LruShadow::table_bytes(zones);
  }

 private:
  std::span<const ZoneId> ahead() const noexcept { return {ahead_.data(), ahead_count_}; }
  ZoneId least_expected(const EvictionCandidates& candidates) noexcept;
  ZoneId first_outside_shadow(const EvictionCandidates& candidates) const noexcept;

  UseForecast forecast_;
  LruShadow shadow_;
  ZoneId zone_ = kNoZone;
  ZoneId zone_before_ = kNoZone;
  std::array<ZoneId, Command::kMostRoute> ahead_{};  // a copy: a new hint overwrites the old one
  std::size_t ahead_count_ = 0;
  std::int64_t most_loss_;    // slots
  std::int64_t most_credit_;  // slots
  std::int64_t loss_ = 0;     // slots loaded, less those that the shadow loaded
  bool approached_ = false;   // a zone, in this cycle
  bool follows_shadow_ = false;
};

static_assert(sizeof(ExpectedUse) <= ExpectedUse::kOwnBytes);

std::unique_ptr<EvictionOrder> make_expected_use(const EvictionPlace& place);

}  // namespace zonepack
