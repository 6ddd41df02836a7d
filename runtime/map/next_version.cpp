// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/next_version.hpp"

#include <algorithm>
#include <optional>

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
    if (!next.zones[zone].loadable) continue;
    if (auto checked = check_pack(next, zone, mode); !checked) return checked;
  }
  return {};
}

Outcome<void> check_claims(const Catalog& map, bool without_budget, ReadMode mode) {
  std::uint64_t most_confirmed = 0;
  std::optional<ZoneId> largest;  // of those that nothing confirms
  Error fault;
  for (ZoneId zone = 0; zone < map.zones.size(); ++zone) {
    if (!map.zones[zone].loadable) continue;
    const auto pack = open_pack(map, zone, mode);
    const std::uint32_t slots = map.zones[zone].slots;
    if (pack) {
      most_confirmed = std::max<std::uint64_t>(most_confirmed, slots);
      continue;
    }
    const Error error = pack.error();
    const bool false_claim = error.code == ErrorCode::kTooLarge ||
                             (error.code == ErrorCode::kMismatch && error.detail == kFalseClaim);
    if (false_claim) return failure(load_fault(map, zone, error), error.code);
    if (!largest || slots > map.zones[*largest].slots) {
      largest = zone;
      fault = error;
    }
  }
  if (!without_budget || !largest || map.zones[*largest].slots <= 2 * most_confirmed) return {};
  return failure(load_fault(map, *largest, fault) +
                     "; without memory.budget, nothing but this pack can confirm the " +
                     std::to_string(map.zones[*largest].slots) + " slots that the manifest claims",
                 fault.code);
}

}  // namespace zonepack
