// SPDX-License-Identifier: Apache-2.0
#include "packer/update/held_signatures.hpp"

#include "packer/decode/zone_records.hpp"

namespace zonepack::packer {

HeldSignatures::HeldSignatures(const MapReader& map) {
  const auto& zones = *map.manifest().zones();
  for (ZoneId zone = 0; zone < zones.size(); ++zone) {
    ZoneRecords records(map, *zones.Get(zone), kCoreOnly);
    for (SignatureRecord record; records.next(record);) {
      Signature& held = by_id_[record.id];
      held.zone = zone;
      held.session = record.map_id;
      held.stamp = record.stamp;
      held.odometry_pose = record.odometry_pose;
      held.links.clear();
      for (const Link& link : record.links) held.links.push_back(link.to);
      ++sessions_[record.map_id];
    }
  }
}

const HeldSignatures::Signature* HeldSignatures::find(std::int32_t id) const noexcept {
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : &found->second;
}

}  // namespace zonepack::packer
