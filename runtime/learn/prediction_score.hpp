// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "runtime/learn/zone_drive.hpp"
#include "runtime/zones/transitions.hpp"

namespace zonepack {

// How well the next zone of drives was known before it was entered.
struct PredictionScore {
  std::uint64_t steps = 0;      // from a zone to a neighbour
  std::uint64_t first = 0;      // it was the likeliest
  std::uint64_t first_two = 0;  // or the second

  void add(const PredictionScore& other) noexcept {
    steps += other.steps;
    first += other.first;
    first_two += other.first_two;
  }
};

// Counts the steps of a drive.
void learn_drive(const ZoneDrive& drive, Transitions& into);

// Predicts each step of a drive, by what is known at its start; with `learns`, by the steps before
// it as well.
PredictionScore score_drive(const ZoneDrive& drive, Transitions& known, bool learns = false);

// Names of zones in a drive that the map does not have, each once, sorted.
std::vector<std::string> unknown_zones(const ZoneDrive& drive, const ZoneGraph& graph);

}  // namespace zonepack
