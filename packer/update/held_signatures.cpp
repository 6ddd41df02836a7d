// SPDX-License-Identifier: Apache-2.0
#include "packer/update/held_signatures.hpp"

#include <cmath>
#include <utility>

#include "packer/decode/zone_records.hpp"

namespace zonepack::packer {

std::optional<SignatureIdentity> identity_of(double stamp, const std::string& label,
                                             const std::optional<Transform>& odometry_pose,
                                             const std::optional<Transform>& pose) {
  if (!std::isfinite(stamp)) return std::nullopt;
  if (odometry_pose) return SignatureIdentity{stamp, "", *odometry_pose};
  if (!label.empty()) return SignatureIdentity{stamp, label, Transform{}};
  if (pose) return SignatureIdentity{stamp, "", *pose};
  return std::nullopt;
}

HeldSignatures::HeldSignatures(std::map<std::int32_t, Signature> by_id) : by_id_(std::move(by_id)) {
  for (const auto& [id, signature] : by_id_) ++sessions_[signature.session];
}

HeldSignatures::HeldSignatures(const MapReader& map) {
  const auto& zones = *map.manifest().zones();
  for (ZoneId zone = 0; zone < zones.size(); ++zone) {
    ZoneRecords records(map, *zones.Get(zone), kCoreOnly);
    for (SignatureRecord record; records.next(record);) {
      Signature& held = by_id_[record.id];
      held.zone = zone;
      held.session = record.map_id;
      held.stamp = record.stamp;
      held.identity = identity_of(record.stamp, record.label, record.odometry_pose, record.pose);
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
