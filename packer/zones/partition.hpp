// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "packer/zones/zone_plan.hpp"
#include "runtime/pack_format/ids.hpp"

// Which zone each signature belongs to (K_z = {k in K : k in z}, arXiv 2512.12228).
//
// The rule, for the base position (x, y, z) of a signature in the map:
//
// 1. Only zones whose z range contains z count (z_min <= z < z_max; a zone without bounds contains
//    every height). Nothing else separates floors above each other.
//
// 2. A zone that has it inside takes precedence over one that has it on its border (side_of:
//    within 1e-9 m of an edge).
//
// 3. Among several zones that have it inside, or several that have it on their border, it goes to
//    the one whose name sorts first by bytes.
//
// 4. In no zone, it is an orphan. Its nearest zone is the one with the nearest border, among
//    equally near ones the first by name; zones of the right height, if any, come first.
//
// So every signature is in at most one zone, whatever the order of zones and signatures.
namespace zonepack::packer {

struct SignaturePlace {
  SignatureId id = 0;
  Point2 p_map;
  double z_map_m = 0;
};

enum class OrphanPolicy : std::uint8_t {
  kNearest,  // to the nearest zone
  kDrop,     // to none
  kError,    // std::runtime_error that names the orphans
};

struct Orphan {
  SignatureId id = 0;
  Point2 p_map;
  std::uint32_t nearest_zone = 0;  // index in the list of zones
  double distance_m = 0;           // to its border
};

struct Partition {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> zone_of;   // per signature, in input order; kNone: dropped
  std::vector<std::size_t> signatures;  // per zone
  std::vector<Orphan> orphans;          // in input order, under every policy
  std::size_t on_border = 0;            // signatures that rules 2 and 3 assigned from a border
};

// `zones` must be sorted by name and not empty. Throws std::runtime_error for a position that is
// not finite and, under kError, for orphans. O(signatures x vertices of zones with a near box).
Partition partition(std::span<const PlannedZone> zones, std::span<const SignaturePlace> signatures,
                    OrphanPolicy policy);

// The zone at one place after the other, by rules 1 to 3; kNone outside of all.
//
// Ownership: refers to the zones.
// Threads: any.
class ZoneLookup {
 public:
  explicit ZoneLookup(std::span<const PlannedZone> zones);
  std::uint32_t at(Point2 p_map, double z_map_m) const;

 private:
  std::span<const PlannedZone> zones_;
  std::vector<Box2> boxes_;
};

// How many signatures are in none of the zones, by rules 1 and 2.
std::size_t count_outside(std::span<const PlannedZone> zones,
                          std::span<const SignaturePlace> signatures);

}  // namespace zonepack::packer
