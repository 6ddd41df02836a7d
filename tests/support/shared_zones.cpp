// SPDX-License-Identifier: Apache-2.0
#include "tests/support/shared_zones.hpp"

#include <algorithm>
#include <cstring>

#include "platform/base/require.hpp"
#include "runtime/pack_format/file/pack_file.hpp"

namespace zonepack::test_support {
namespace {

SharedMap laid_out(std::span<std::byte> memory, std::uint32_t zones, std::uint32_t slots) {
  Result<SharedMap> map = SharedMap::lay_out(memory, zones, slots);
  ZP_REQUIRE(map.ok() && map->begin_map(zones).ok());
  return *map;
}

}  // namespace

SharedZones::SharedZones(std::span<std::byte> memory, std::uint32_t zones, std::uint32_t slots)
    : map_(laid_out(memory, zones, slots)), pool_(map_.links()) {}

void SharedZones::leave_gaps() {
  ZP_REQUIRE(chains_.empty());
  SlotChain used;
  while (pool_.take_one(used) && pool_.take_one(gaps_)) continue;
  pool_.give_back(used);
}

std::uint32_t SharedZones::slots_for(std::span<const ChunkRef> chunks) {
  Placement placement;
  for (const ChunkRef& chunk : chunks) {
    placement.add(static_cast<std::uint32_t>(chunk.bytes.size()));
  }
  return placement.slots();
}

SlotChain SharedZones::fill(std::span<const ChunkRef> chunks) {
  SlotChain chain;
  ZP_REQUIRE(pool_.take(slots_for(chunks), chain));
  for (SlotIndex s = chain.head; s != kNoSlot; s = pool_.next(s)) {
    std::ranges::fill(map_.chunks(s), SharedChunk{});
  }
  Placement placement;
  SlotIndex slot = chain.head;
  std::uint32_t at_slot = 0, in_slot = 0;
  for (const ChunkRef& chunk : chunks) {
    const auto place = placement.add(static_cast<std::uint32_t>(chunk.bytes.size()));
    for (; at_slot < place.slot; ++at_slot, in_slot = 0) slot = pool_.next(slot);
    std::memcpy(map_.slot(slot).data() + place.offset, chunk.bytes.data(), chunk.bytes.size());
    map_.chunks(slot)[in_slot++] = {static_cast<std::uint8_t>(chunk.kind),
                                    static_cast<std::uint8_t>(place.offset / kChunkAlignment),
                                    static_cast<std::uint16_t>(chunk.bytes.size())};
  }
  return chain;
}

std::uint32_t SharedZones::put(ZoneId zone, std::span<const ChunkRef> chunks) {
  ZP_REQUIRE(!chains_.contains(zone));
  const SlotChain chain = fill(chunks);
  const std::uint32_t generation = ++generations_[zone];
  map_.publish(zone, generation, chain);
  chains_[zone] = chain;
  return generation;
}

void SharedZones::remove(ZoneId zone) {
  map_.withdraw(zone);
  pool_.give_back(chains_.at(zone));
  chains_.erase(zone);
}

}  // namespace zonepack::test_support
