// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "packer/decode/map_reader.hpp"
#include "packer/tune/layout.hpp"

// A packed map as the layout that a tuning begins with, and what other zones of it would charge.
namespace zonepack::packer::tune {

struct HeldMap {
  std::vector<Signature> signatures;  // by id
  Layout layout;                      // zones in the manifest's order
};

// Throws std::runtime_error for a map without places of its signatures, and for a cloud, whose
// tiles are cut anew along the borders of zones.
HeldMap read_held_map(const MapReader& map, const std::string& folder, PayloadMask payload,
                      std::span<const ZoneId> pinned, const std::vector<std::string>& layers);

// Packs zones of some signatures for nothing but their size: exactly what a build charges.
//
// Memory: the signatures of one zone.
class PackScale {
 public:
  PackScale(const MapReader& map, PayloadMask payload);
  ~PackScale();
  PackScale(const PackScale&) = delete;
  PackScale& operator=(const PackScale&) = delete;

  PackCost weigh(const TunedZone& zone, std::span<const Signature> signatures) const;

 private:
  const MapReader& map_;
  PayloadMask payload_;
  std::filesystem::path folder_;
};

}  // namespace zonepack::packer::tune
