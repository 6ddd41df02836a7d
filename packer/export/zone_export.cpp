// SPDX-License-Identifier: Apache-2.0
#include "packer/export/zone_export.hpp"

#include "packer/decode/zone_records.hpp"
#include "packer/export/block_json.hpp"
#include "packer/export/cloud_json.hpp"
#include "packer/export/keyframe_json.hpp"
#include "packer/export/signature_json.hpp"

namespace zonepack::packer {
namespace {

// Each kind of map is exported in its own terms.
auto writer_of(const fb::Manifest& manifest) {
  const std::string kind = flatbuffers::GetString(manifest.provenance()->source_kind());
  if (kind == "stella") return &write_keyframe;
  if (kind == "nvblox") return &write_blocks;
  return kind == "pcd" || kind == "autoware" || kind == "glim" ? &write_tile : &write_signature;
}

}  // namespace

void export_zone(const MapReader& map, const fb::Zone& zone, JsonLines& json,
                 ByteCount window_bytes) {
  const auto write = writer_of(map.manifest());
  ZoneRecords records(map, zone, kEveryPayload, window_bytes);
  for (SignatureRecord record; records.next(record);) {
    write(json, zone.name()->string_view(), record, map.manifest().payload_mask());
  }
}

}  // namespace zonepack::packer
