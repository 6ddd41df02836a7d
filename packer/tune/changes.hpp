// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "packer/tune/layout.hpp"
#include "packer/zones/cut.hpp"

// What can be changed about a layout: zones cut in two, and neighbours made one.
namespace zonepack::packer::tune {

struct Change {
  enum class Kind : std::uint8_t { kSplit, kMerge };
  Kind kind = Kind::kSplit;
  std::uint32_t zone_a = 0, zone_b = 0;  // the second for a merge
  Axis axis;                             // of a split: cut across it ...
  double place_m = 0;                    // ... here
};

// No part of a split is narrower along the cut's axis than this: at a robot's speed, some seconds
// in which the next part can be read.
inline constexpr double kLeastPart_m = 2.5;
// A cut stays this far off the ends of portals.
inline constexpr double kPortalMargin_m = 0.3;
// A portal this wide is no door: a cut may part it.
inline constexpr double kOpenGround_m = 3;
// Parts meet in at least one portal this wide.
inline constexpr double kLeastSeam_m = 0.8;
// Walls between zones that become one, at most.
inline constexpr double kThickestWall_m = 0.2;

// Straight cuts through a zone, at most `most` along its length and as many across: between
// signatures, through no door, with signatures on both sides.
std::vector<Change> splits_of(const Layout& layout, std::span<const Signature> signatures,
                              std::uint32_t zone, std::size_t most);

// Pairs of neighbours that could be one zone: of one layer, floor and height.
std::vector<Change> merges_of(const Layout& layout);

// The zones of before and after, as "L1" and as "L1_1, L1_2".
struct ChangeNames {
  std::vector<std::string> from, into;
};

struct Changed {
  Layout layout;
  ChangeNames names;
  std::vector<std::uint32_t> fresh;  // indices of the new zones
};

// The layout with this change, its new zones estimated: slots and stored bytes by the shares of
// their signatures. nullopt where the outlines do not allow it: a cut in more than two pieces,
// parts without a passage, zones whose common outline falls apart, names that are too long.
std::optional<Changed> changed(const Layout& layout, std::span<const Signature> signatures,
                               const Change& change);

// Places and visits of a track after a change. Only places in the zones changed are looked at.
std::vector<Visit> visits_after(const Track& track, const Change& change, const Changed& changed);
void follow(Track& track, const Change& change, const Changed& changed);

// Two zones and the wall between them as one outline; nullopt when it is none.
std::optional<Polygon> joined(const Polygon& a, const Polygon& b);

}  // namespace zonepack::packer::tune
