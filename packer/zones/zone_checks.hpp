// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/zones/drawn.hpp"
#include "packer/zones/findings.hpp"
#include "packer/zones/zone_plan.hpp"

// The rules that zones must keep, each alone and with each other.
namespace zonepack::packer {

// What is wrong with one outline, as the end of a sentence about its zone: it crosses itself, has
// no area, a hole leaves it or meets another hole, too many vertices. Empty: sound.
std::vector<std::string> outline_faults(const Polygon& polygon);

// Names that stand twice, zones that overlap by more than kMaxOverlap (unless their heights
// differ), and a drawing so small that it must be in degrees.
void check_zones_together(const Drawing& drawing, Findings& findings);

// The zones that no chain of portals joins to the largest group of zones (of equal groups: the one
// with the first zone).
std::vector<std::uint32_t> unreachable_zones(const ZonePlan& plan);

}  // namespace zonepack::packer
