// SPDX-License-Identifier: Apache-2.0
#include "packer/export/zone_export.hpp"

#include "packer/decode/zone_records.hpp"
#include "packer/export/signature_json.hpp"

namespace zonepack::packer {

void export_zone(const MapReader& map, const fb::Zone& zone, JsonLines& json,
                 ByteCount window_bytes) {
  ZoneRecords records(map, zone, kEveryPayload, window_bytes);
  for (SignatureRecord record; records.next(record);) {
    write_signature(json, zone.name()->string_view(), record, map.manifest().payload_mask());
  }
}

}  // namespace zonepack::packer
