// SPDX-License-Identifier: Apache-2.0
// usage: zone_blocks MAP: every block of voxels of every zone, as a program sees it in zoned's
// memory: zone, index, layer and BLAKE2b-128 of the block as nvblox stores it, a line each.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "packer/decode/map_reader.hpp"
#include "platform/memory/shared_memory.hpp"
#include "runtime/client/shared_reader.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "tests/support/shared_zones.hpp"

using namespace zonepack;

namespace {

void print_zone(const std::string& zone, const ZoneSignatures& signatures) {
  static constexpr const char* kNames[] = {"tsdf_layer", "color_layer", "occupancy_layer",
                                           "esdf_layer"};
  const BlocksView blocks = signatures.blocks();
  std::vector<std::byte> bytes;
  blocks.for_each([&](const BlockView& each) {
    const BlockPosition p = each.position();
    const auto found = blocks.find(p.x, p.y, p.z);
    for (std::uint32_t i = 0; i < kVoxelLayers; ++i) {
      const auto layer = static_cast<VoxelLayer>(i);
      if (!found || !found->has(layer)) continue;
      bytes.resize(bytes_of_block(planes_of(layer)));
      if (!found->copy(layer, bytes)) std::exit(1);
      std::printf("%s %d %d %d %s %s\n", zone.c_str(), p.x, p.y, p.z, kNames[i],
                  to_hex(blake2b_16(bytes)).c_str());
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const packer::MapReader map(argv[1]);
  for (const fb::Zone* zone : *map.manifest().zones()) {
    const PackReader pack = map.open_pack(*zone);
    const auto decoded = DecodedPack::decode(pack, kDefaultPayload);
    if (!decoded) return 1;
    const std::uint32_t slots = test_support::SharedZones::slots_for(decoded->chunks());
    if (slots == 0) continue;
    SharedMemory memory = SharedMemory::create("zone_blocks", shared_map_bytes(1, slots)).value();
    test_support::SharedZones zones(memory.bytes(), 1, slots);
    zones.put(0, decoded->chunks());
    SharedReader reader = SharedReader::open(memory.bytes()).value();
    const ReadStatus read = reader.read(
        0, [&](const ZoneSignatures& signatures) { print_zone(zone->name()->str(), signatures); });
    if (read != ReadStatus::kOk) return 1;
  }
}
