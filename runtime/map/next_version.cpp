// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/next_version.hpp"

#include "runtime/map/load_fault.hpp"
#include "runtime/map/loader.hpp"

namespace zonepack {
namespace {

Outcome<void> check_pack(const Catalog& map, ZoneId zone, ReadMode mode) {
  const CatalogZone& wanted = map.zones[zone];
  const auto file = StorageFile::open(map.folder + "/" + wanted.pack, mode);
  Error error = file.error();
  if (file && file->size() < wanted.pack_bytes) {
    error = {ErrorCode::kTruncated, static_cast<std::int64_t>(file->size())};
  } else if (file && file->size() > wanted.pack_bytes) {
    error = {ErrorCode::kMismatch};
  } else if (file) {
    error = open_pack(map, zone, mode).error();
  }
  if (error.code == ErrorCode::kOk) return {};
  return failure(load_fault(map, zone, error), error.code);
}

}  // namespace

Outcome<void> check_next_version(const Catalog& in_use, const Catalog& next, ReadMode mode) {
  if (next.lineage != in_use.lineage) {
    return failure(next.folder + "/" + std::string(kManifestName) + ": is another map (lineage " +
                       to_hex(next.lineage) + ", not " + to_hex(in_use.lineage) +
                       "), where the robot's pose means nothing; start zoned again with it",
                   ErrorCode::kMismatch);
  }
  if (next.version == in_use.version) {
    return failure(next.folder + ": is the version that is in use", ErrorCode::kExists);
  }
  for (ZoneId zone = 0; zone < next.zones.size(); ++zone) {
    if (auto checked = check_pack(next, zone, mode); !checked) return checked;
  }
  return {};
}

}  // namespace zonepack
