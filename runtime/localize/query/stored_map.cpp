// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/stored_map.hpp"

#include <utility>

#include "platform/base/shell_word.hpp"
#include "runtime/client/signature_view.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::localize {

Outcome<StoredMap> open_stored_map(const std::string& folder) {
  constexpr PayloadMask kWanted = kCoreOnly | mask_of(fb::PayloadKind::Features);
  auto catalog = Catalog::open(folder, kWanted);
  if (!catalog) {
    return failure(folder + "/" + std::string(kManifestName) + ": cannot be used: " +
                       catalog.error().message + "; give a folder that zonepack build wrote",
                   catalog.error().code);
  }
  auto detector = parse_detector(catalog->detector, folder);
  if (!detector) return std::move(detector).error();
  return StoredMap{std::move(*catalog), *detector};
}

Outcome<DecodedPack> decode_zone(const Catalog& catalog, const CatalogZone& zone,
                                 PayloadMask wanted) {
  const std::string file = catalog.folder + "/" + zone.pack;
  const auto bad = [&](const Error& error) {
    return failure(file + ": zone '" + zone.name + "' cannot be read: " + reason_text(error) +
                       "; zonepack verify " + shell_word(catalog.folder) + " says more",
                   error.code);
  };
  const auto pack = PackReader::open(file, &zone.pack_digest);
  if (!pack) return bad(pack.error());
  auto decoded = DecodedPack::decode(*pack, wanted);
  if (!decoded) return bad(decoded.error());
  return std::move(decoded).value();
}

Outcome<std::vector<MapFeatures>> read_zone_features(const StoredMap& map, ZoneId zone) {
  const auto decoded = decode_zone(map.catalog, map.catalog.zones.at(zone),
                                   kCoreOnly | mask_of(fb::PayloadKind::Features));
  if (!decoded) return decoded.error();
  return copy_features(ZoneSignatures(decoded->view()), zone, map.detector.descriptor_bytes());
}

}  // namespace zonepack::localize
