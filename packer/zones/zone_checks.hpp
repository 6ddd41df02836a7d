// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/zones/drawn.hpp"
#include "packer/zones/findings.hpp"
#include "packer/zones/zone_plan.hpp"

// The rules for zones, each on its own and together.
namespace zonepack::packer {

// What is wrong with one outline: the end of a sentence about its zone, and where.
struct OutlineFault {
  std::string message;
  FindingPlace place = {};
};

// It crosses itself, has no area, a hole leaves it or meets another hole, too many vertices. Empty
// when it is sound.
std::vector<OutlineFault> outline_faults(const Polygon& polygon);

// Reports duplicate names, zones that overlap by more than kMaxOverlap (unless their heights
// differ), and a drawing so small that it must be in degrees.
void check_zones_together(const Drawing& drawing, Findings& findings);

// The zones that no chain of portals joins to the largest group of zones (among equal groups, the
// one with the first zone).
std::vector<std::uint32_t> unreachable_zones(const ZonePlan& plan);

}  // namespace zonepack::packer
