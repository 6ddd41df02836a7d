// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "packer/record/map_source.hpp"
#include "packer/sources/cloud/cloud_map.hpp"

namespace zonepack::packer {

// A point cloud: a tile is a signature with a scan.
//
// pose: T_map_base, the base being the point nearest to the middle of the tile. Scan: float32 x, y,
// z and what else there is, in blocks of 32 neighbours; T_base_scan leads from the file's own
// coordinates (float64 ones: from the corner of the tile). Format: RTAB-Map's 5 XYZ, 6 XYZI, 7
// XYZRGB where it is one of these, else kCloudFormat plus a bit for each field, in this order: 1
// intensity, 2 rgb (the bits 0x00RRGGBB), 4 ring.
class CloudSource : public MapSource {
 public:
  static constexpr std::int32_t kCloudFormat = 256;

  CloudSource(const char* kind, std::shared_ptr<const CloudMap> cloud, std::string name);

  std::unique_ptr<MapSource> reopen() const override;
  const MapOutline& outline() const noexcept override { return *outline_; }
  void require_unchanged() const override { cloud_->require_unchanged(); }
  void read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) override;
  using MapSource::read;

 private:
  CloudSource(std::string name, std::shared_ptr<const CloudMap> cloud,
              std::shared_ptr<const MapOutline> outline);
  Scan scan_of(const CloudTile& tile);

  std::string name_;
  std::shared_ptr<const CloudMap> cloud_;
  std::shared_ptr<const MapOutline> outline_;
  TilePoints points_;
};

}  // namespace zonepack::packer
