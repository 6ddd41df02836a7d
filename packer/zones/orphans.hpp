// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "packer/zones/partition.hpp"

// What signatures in no zone say about a drawing: near which zones they stand, and whether the
// drawing as a whole is off.
namespace zonepack::packer {

// Orphans of one nearest zone: those within kNearOrphan_m of it, or those farther off.
struct OrphanGroup {
  std::uint32_t nearest_zone = 0;
  std::size_t count = 0;
  double farthest_m = 0;  // from the zone
  SignatureId example = 0;
};
inline constexpr double kNearOrphan_m = 1;

// Largest first; equal ones by zone, the near before the far.
std::vector<OrphanGroup> group_orphans(std::span<const Orphan> orphans);

// "64 in none, 43 of them within 0.6 m of Lobby"; "0 in none". Distances are rounded up, to 0.1 m
// or, from 10 m on, to whole metres.
std::string orphans_text(std::span<const OrphanGroup> groups, std::span<const PlannedZone> zones);

// "43 of them within 0.6 m of Lobby"; "both within ..." or "all within ..." when that is
// everything. `groups` must not be empty.
std::string groups_text(std::span<const OrphanGroup> groups, std::span<const PlannedZone> zones);

// "within 0.6 m of Lobby", or "1 to 2.4 m from Lobby" for those farther off.
std::string near_text(const OrphanGroup& group, std::span<const PlannedZone> zones);

// The drawing holds far more signatures when its positions are read otherwise.
struct Misdrawn {
  std::string how;     // "x and y swapped"
  std::string remedy;  // what to do about it
  std::size_t orphans = 0;
};

// Looks for swapped axes, mirror images, quarter and half turns and other units. Something is found
// only when at least a quarter of the signatures are in no zone, and read otherwise at most half as
// many, and fewer by a quarter of all. `zones` must not be empty.
std::optional<Misdrawn> find_misdrawn(std::span<const PlannedZone> zones,
                                      std::span<const SignaturePlace> places, std::size_t orphans);

// "612 of 1095 in no zone; with x and y swapped 64: ...", for a warning.
std::string misdrawn_text(const Misdrawn& misdrawn, std::size_t orphans, std::size_t signatures);

}  // namespace zonepack::packer
