// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/next_version.hpp"

#include "runtime/map/loader.hpp"

namespace zonepack {
namespace {

Result<void> check_pack(const Catalog& map, ZoneId zone, ReadMode mode, std::string& fault) {
  const CatalogZone& wanted = map.zones[zone];
  const auto pack = open_pack(map, zone, mode);
  const bool whole = pack && pack->file().size() == wanted.pack_bytes;
  if (whole) return {};
  const Error error = pack ? Error{ErrorCode::kTruncated, static_cast<std::int64_t>(
                                                              pack->file().size())}
                           : pack.error();
  fault = map.folder + "/" + wanted.pack + ": " + to_string(error.code) + ", expected " +
          std::to_string(wanted.pack_bytes) + " bytes with the signatures of zone " + wanted.name +
          "; copy the packs before the manifest, or copy the map again";
  return error;
}

}  // namespace

Result<void> check_next_version(const Catalog& in_use, const Catalog& next, ReadMode mode,
                                std::string& fault) {
  if (next.lineage != in_use.lineage) {
    fault = next.folder + "/" + std::string(kManifestName) + ": is another map (lineage " +
            to_hex(next.lineage) + ", not " + to_hex(in_use.lineage) +
            "), where the robot's pose means nothing; start zoned again with it";
    return ErrorCode::kMismatch;
  }
  if (next.version == in_use.version) {
    fault = next.folder + ": is the version that is in use";
    return ErrorCode::kExists;
  }
  for (ZoneId zone = 0; zone < next.zones.size(); ++zone) {
    if (const auto checked = check_pack(next, zone, mode, fault); !checked) return checked;
  }
  return {};
}

}  // namespace zonepack
