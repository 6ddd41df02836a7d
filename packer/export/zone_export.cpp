// SPDX-License-Identifier: Apache-2.0
#include "packer/export/zone_export.hpp"

#include <stdexcept>
#include <vector>

#include "packer/decode/record_decoder.hpp"
#include "packer/export/cloud_json.hpp"
#include "packer/export/keyframe_json.hpp"
#include "packer/export/signature_json.hpp"

namespace zonepack::packer {
namespace {

// Runs of signatures whose chunks are about `window_bytes` long.
std::vector<OrdinalRange> windows_of(const fb::PackIndex& index, ByteCount window_bytes) {
  std::vector<std::uint64_t> bytes(index.signatures());
  for (const fb::ChunkEntry* entry : *index.chunks()) {
    bytes[entry->first_signature()] += entry->decoded_size();
  }
  std::vector<OrdinalRange> windows;
  std::uint64_t sum = 0;
  for (std::uint32_t i = 0; i < index.signatures(); ++i) {
    if (windows.empty() || sum + bytes[i] > window_bytes) {
      windows.push_back({i, i});
      sum = 0;
    }
    windows.back().last = i;
    sum += bytes[i];
  }
  return windows;
}

// Each kind of map is exported in its own terms.
auto writer_of(const fb::Manifest& manifest) {
  const std::string kind = flatbuffers::GetString(manifest.provenance()->source_kind());
  if (kind == "stella") return &write_keyframe;
  return kind == "pcd" || kind == "autoware" || kind == "glim" ? &write_tile : &write_signature;
}

}  // namespace

void export_zone(const MapReader& map, const fb::Zone& zone, JsonLines& json,
                 ByteCount window_bytes) {
  const auto write = writer_of(map.manifest());
  const std::string path = map.pack_path(zone);
  const PackReader pack = map.open_pack(zone);
  for (const OrdinalRange window : windows_of(pack.index(), window_bytes)) {
    const Result<DecodedPack> decoded = DecodedPack::decode(pack, kEveryPayload, window);
    if (!decoded) MapReader::fail(path, decoded.error());
    if (decoded->view().size() != window.last - window.first + 1) {
      MapReader::fail(path, {ErrorCode::kMismatch, window.first});
    }
    for (std::uint32_t i = window.first; i <= window.last; ++i) {
      try {
        write(json, zone.name()->string_view(), decode_record(decoded->view(), i),
              map.manifest().payload_mask());
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(path + ": " + error.what() + "; build the map again");
      }
    }
  }
}

}  // namespace zonepack::packer
