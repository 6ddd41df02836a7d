// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/query/map_folder.hpp"

#include <utility>

#include "runtime/client/signature_view.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"

namespace zonepack::localize {

Outcome<MapFolder> open_map_folder(const std::string& folder) {
  constexpr PayloadMask kWanted = kCoreOnly | mask_of(fb::PayloadKind::Features);
  std::string why;
  Result<Catalog> catalog = Catalog::open(folder, kWanted, Catalog::kNoMost, &why);
  if (!catalog) {
    return failure(folder + "/" + std::string(kManifestName) +
                       ": cannot be used: " + (why.empty() ? reason_text(catalog.error()) : why) +
                       "; give a folder that zonepack build wrote",
                   catalog.error().code);
  }
  auto bytes = read_manifest_file(folder, Catalog::kNoMost, ReadMode::kCached);
  if (!bytes) return failure(folder + ": " + reason_text(bytes.error()), bytes.error().code);
  const auto manifest = check_manifest(*bytes);
  if (!manifest) return failure(folder + ": changed while it was read; try again");
  const flatbuffers::String* const text = (*manifest)->provenance()->detector();
  auto detector =
      parse_detector(text == nullptr ? std::string_view() : text->string_view(), folder);
  if (!detector) return std::move(detector).error();
  return MapFolder{std::move(*catalog), *detector};
}

Outcome<std::vector<MapFeatures>> read_zone_features(const MapFolder& map, ZoneId zone) {
  const CatalogZone& entry = map.catalog.zones.at(zone);
  const std::string file = map.catalog.folder + "/" + entry.pack;
  const auto bad = [&](const Error& error) {
    return failure(file + ": zone '" + entry.name + "' cannot be read: " + reason_text(error) +
                       "; zonepack verify " + map.catalog.folder + " says more",
                   error.code);
  };
  const auto pack = PackReader::open(file, &entry.pack_digest);
  if (!pack) return bad(pack.error());
  const auto decoded = DecodedPack::decode(*pack, kCoreOnly | mask_of(fb::PayloadKind::Features));
  if (!decoded) return bad(decoded.error());
  std::vector<MapFeatures> out;
  const ZoneSignatures signatures(decoded->view());
  for (std::uint32_t i = 0; i < signatures.size(); ++i) {
    auto features = copy_features(signatures[i], zone, map.detector.descriptor_bytes());
    if (features) out.push_back(std::move(*features));
  }
  return out;
}

}  // namespace zonepack::localize
