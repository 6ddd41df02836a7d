// SPDX-License-Identifier: Apache-2.0
#include "runtime/memory/shared_map.hpp"

#include <new>

#include "platform/base/require.hpp"

namespace zonepack {

SharedMap::SharedMap(std::byte* memory) noexcept
    : memory_(memory),
      header_(reinterpret_cast<SharedHeader*>(memory)),
      zones_(reinterpret_cast<SharedZone*>(memory + header_->zones_at)) {}

Result<SharedMap> SharedMap::lay_out(std::span<std::byte> memory, std::uint32_t zone_capacity,
                                     std::uint32_t slots) {
  const SharedPlaces at = shared_places(zone_capacity, slots);
  if (memory.size() != at.total) return {ErrorCode::kMismatch, static_cast<std::int64_t>(at.total)};
  auto* header = reinterpret_cast<SharedHeader*>(memory.data());
  if (header->magic == 0) {
    header = new (memory.data()) SharedHeader{};
    header->version = kSharedVersion;
    header->slot_bytes = kSlotBytes;
    header->zone_capacity = zone_capacity;
    header->slot_count = slots;
    header->zones_at = at.zones;
    header->links_at = at.links;
    header->chunks_at = at.chunks;
    header->slots_at = at.slots;
    header->total_bytes = at.total;
    header->magic = kSharedMagic;
  } else if (!shared_header_is_sound(*header, memory.size()) ||
             header->zone_capacity != zone_capacity) {
    return ErrorCode::kMismatch;
  }
  SharedMap map(memory.data());
  for (std::uint32_t zone = 0; zone < zone_capacity; ++zone) map.withdraw(zone);
  const Result<void> begun = map.begin_map(0);
  ZP_REQUIRE(begun.ok());
  return map;
}

Result<void> SharedMap::begin_map(std::uint32_t zones) noexcept {
  if (zones > header_->zone_capacity) return {ErrorCode::kTooLarge, zones};
  header_->epoch.fetch_add(1, std::memory_order_acq_rel);
  header_->zone_count.store(zones, std::memory_order_release);
  return {};
}

void SharedMap::publish(ZoneId zone, std::uint32_t generation, const SlotChain& slots) noexcept {
  ZP_REQUIRE(zone < header_->zone_capacity);
  SharedZone& shared = zones_[zone];
  shared.head.store(slots.head, std::memory_order_relaxed);
  shared.slots.store(slots.count, std::memory_order_relaxed);
  const std::uint64_t epoch = header_->epoch.load(std::memory_order_relaxed);
  shared.state.store(epoch << 32 | generation, std::memory_order_release);
}

void SharedMap::withdraw(ZoneId zone) noexcept {
  ZP_REQUIRE(zone < header_->zone_capacity);
  zones_[zone].state.store(0, std::memory_order_relaxed);
  // Every reader sees this before the new owner's writes to the slots.
  std::atomic_thread_fence(std::memory_order_seq_cst);
}

std::optional<std::uint32_t> SharedMap::generation(ZoneId zone) const noexcept {
  if (zone >= header_->zone_capacity) return std::nullopt;
  const std::uint64_t state = zones_[zone].state.load(std::memory_order_acquire);
  if (state == 0) return std::nullopt;
  return static_cast<std::uint32_t>(state);
}

std::span<std::byte> SharedMap::slot(SlotIndex index) noexcept {
  ZP_REQUIRE(index < header_->slot_count);
  return {memory_ + header_->slots_at + std::size_t{index} * kSlotBytes, kSlotBytes};
}

std::span<SlotIndex> SharedMap::links() noexcept {
  return {reinterpret_cast<SlotIndex*>(memory_ + header_->links_at), header_->slot_count};
}

std::span<SharedChunk, kMaxChunksPerSlot> SharedMap::chunks(SlotIndex slot) noexcept {
  ZP_REQUIRE(slot < header_->slot_count);
  auto* all = reinterpret_cast<SharedChunk*>(memory_ + header_->chunks_at);
  return std::span<SharedChunk, kMaxChunksPerSlot>(all + std::size_t{slot} * kMaxChunksPerSlot,
                                                   kMaxChunksPerSlot);
}

}  // namespace zonepack
