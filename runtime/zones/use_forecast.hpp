// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/pack_format/ids.hpp"
#include "runtime/zones/transitions.hpp"

namespace zonepack {

// How soon each zone will be used, as far as can be told: for a zone z that is first entered T
// zones from now, the expectation of kPerZone^T; 0 when z is out of sight.
//
// Where a route is known, its zones come in its order, and what comes after its end is forecast
// from there. A forecast is a walk at random through Transitions: the states are pairs of a zone
// and the zone before it, the first kMostStates reachable ones in breadth-first order. The states'
// chances are carried on kSteps times; in each step z is entered for the first time with the chance
// that it is entered, times the chance that it was not entered earlier (the two are taken as
// independent). What leads out of the states is lost, so what is farther away counts for less than
// it should.
//
// The work can be spread over cycles with advance(); value() does what is left of it at once. So
// the values do not depend on how it was spread.
//
// Real-time: no allocation. A whole forecast asks Transitions at most kMostStates times and does at
// most kSteps * kMostStates * Successors::kMost additions, however large the map is.
// Threads: one at a time.
class UseForecast {
 public:
  static constexpr std::size_t kMostStates = 128;
  static constexpr int kSteps = 60;
  static constexpr float kPerZone = 0.97F;

  // The transitions must outlive this object, and change only just before begin().
  explicit UseForecast(const Transitions& transitions) noexcept : transitions_(transitions) {}

  // The robot is in `now`, which it entered from `before` (kNoZone: not known), and will go through
  // the zones `ahead` in their order (none: not known). The zones ahead must outlive the forecast.
  void begin(ZoneId before, ZoneId now, std::span<const ZoneId> ahead) noexcept;

  // Does a small part of the work that is left: 4 states, or 2 steps.
  void advance() noexcept;
  bool finished() const noexcept { return next_state_ == states_ && step_ == kSteps; }

  // For the zones on the way `ahead` 1 + kPerZone^T, so that what is known comes before what is
  // likely. Finishes the forecast.
  float value(ZoneId zone) noexcept;

 private:
  static constexpr std::uint8_t kNoState = 0xff;
  static_assert(kMostStates < kNoState);

  struct State {
    ZoneId before = kNoZone;
    ZoneId zone = kNoZone;
    std::uint8_t place = 0;  // of the zone in places_
    std::uint8_t ways = 0;
    std::array<std::uint8_t, Successors::kMost> to{};
    std::array<float, Successors::kMost> share{};
  };
  // A zone of the states.
  struct Place {
    ZoneId zone = kNoZone;
    float entered = 0;  // in this step
    float never = 1;    // so far
    float value = 0;
  };

  std::uint8_t state_of(ZoneId before, ZoneId zone) noexcept;
  void explore() noexcept;
  void step() noexcept;

  const Transitions& transitions_;
  std::span<const ZoneId> ahead_;
  std::array<State, kMostStates> state_{};
  std::array<float, kMostStates> chance_{};
  std::array<float, kMostStates> next_chance_{};
  std::array<Place, kMostStates> places_{};
  std::size_t states_ = 0;
  std::size_t next_state_ = 0;  // the first that was not explored
  std::size_t place_count_ = 0;
  int step_ = kSteps;
  float weight_ = 1;  // kPerZone to the number of zones until the next step's
};

}  // namespace zonepack
