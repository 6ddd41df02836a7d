// SPDX-License-Identifier: Apache-2.0
#include "runtime/zones/use_forecast.hpp"

#include <algorithm>

namespace zonepack {
namespace {

constexpr int kStatesAtOnce = 4;
constexpr int kStepsAtOnce = 2;

}  // namespace

void UseForecast::begin(ZoneId before, ZoneId now, std::span<const ZoneId> ahead) noexcept {
  ahead_ = ahead;
  weight_ = 1;
  for (const ZoneId zone : ahead) {
    before = now;
    now = zone;
    weight_ *= kPerZone;
  }
  states_ = next_state_ = place_count_ = 0;
  step_ = 0;
  if (now == kNoZone) {
    step_ = kSteps;
    return;
  }
  state_of(before, now);
  chance_[0] = 1;
}

std::uint8_t UseForecast::state_of(ZoneId before, ZoneId zone) noexcept {
  std::size_t state = 0;
  while (state < states_ && (state_[state].zone != zone || state_[state].before != before)) ++state;
  if (state < states_) return static_cast<std::uint8_t>(state);
  if (state == kMostStates) return kNoState;
  std::size_t place = 0;
  while (place < place_count_ && places_[place].zone != zone) ++place;
  if (place == place_count_) places_[place_count_++] = {zone, 0, 1, 0};
  state_[state] = {before, zone, static_cast<std::uint8_t>(place), 0, {}, {}};
  chance_[state] = next_chance_[state] = 0;
  ++states_;
  return static_cast<std::uint8_t>(state);
}

void UseForecast::explore() noexcept {
  State& state = state_[next_state_++];
  for (const Successor& next : transitions_.after(state.before, state.zone)) {
    const std::uint8_t to = state_of(state.zone, next.zone);
    if (to == kNoState) continue;
    state.to[state.ways] = to;
    state.share[state.ways++] = next.share;
  }
}

void UseForecast::step() noexcept {
  for (std::size_t i = 0; i < states_; ++i) {
    const State& state = state_[i];
    for (std::size_t way = 0; way < state.ways; ++way) {
      next_chance_[state.to[way]] += chance_[i] * state.share[way];
    }
  }
  for (std::size_t i = 0; i < states_; ++i) {
    chance_[i] = next_chance_[i];
    next_chance_[i] = 0;
    places_[state_[i].place].entered += chance_[i];
  }
  weight_ *= kPerZone;
  for (std::size_t i = 0; i < place_count_; ++i) {
    Place& place = places_[i];
    const float first = std::min(place.entered, 1.0F) * place.never;
    place.value += weight_ * first;
    place.never -= first;
    place.entered = 0;
  }
  ++step_;
}

void UseForecast::advance() noexcept {
  if (next_state_ < states_) {
    for (int i = 0; i < kStatesAtOnce && next_state_ < states_; ++i) explore();
    return;
  }
  for (int i = 0; i < kStepsAtOnce && step_ < kSteps; ++i) step();
}

float UseForecast::value(ZoneId zone) noexcept {
  float known = 1;
  for (const ZoneId next : ahead_) {
    known *= kPerZone;
    if (next == zone) return 1 + known;
  }
  while (!finished()) advance();
  for (std::size_t i = 0; i < place_count_; ++i) {
    if (places_[i].zone == zone) return places_[i].value;
  }
  return 0;
}

}  // namespace zonepack
