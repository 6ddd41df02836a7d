// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "platform/base/byte_count.hpp"
#include "platform/base/result.hpp"
#include "runtime/memory/shared_layout.hpp"
#include "runtime/memory/slot_pool.hpp"
#include "runtime/memory/zone_directory.hpp"

namespace zonepack {

// The writer's side of the shared memory.
//
// Ownership: refers to memory that outlives it.
// Threads: publish() and withdraw() by the control thread; slots, links and chunk places by the
// loader, which owns a slot until its zone is published and again after the zone was withdrawn.
// Real-time: nothing allocates.
class SharedMap final : public ZoneDirectory {
 public:
  // Lays out zeroed memory of shared_map_bytes(), or takes over memory laid out earlier for the
  // same numbers: every zone is withdrawn, and a new epoch begins. kMismatch when it was laid out
  // for other numbers.
  static Result<SharedMap> lay_out(std::span<std::byte> memory, std::uint32_t zone_capacity,
                                   std::uint32_t slots);

  void publish(ZoneId zone, std::uint32_t generation, const SlotChain& slots) noexcept override;
  void withdraw(ZoneId zone) noexcept override;

  // Another map's zones replace those of the last one, all of which were withdrawn. kTooLarge
  // beyond the capacity.
  Result<void> begin_map(std::uint32_t zones) noexcept override;

  // The generation that can be read now; nothing when the zone cannot be read. Any thread.
  std::optional<std::uint32_t> generation(ZoneId zone) const noexcept;

  // Incremented at every start of zoned and every change of map.
  std::uint32_t epoch() const noexcept { return header_->epoch.load(std::memory_order_acquire); }

  std::uint32_t slot_count() const noexcept { return header_->slot_count; }
  std::uint32_t zone_capacity() const noexcept { return header_->zone_capacity; }
  std::span<std::byte> slot(SlotIndex index) noexcept;
  std::span<SlotIndex> links() noexcept;
  std::span<SharedChunk, kMaxChunksPerSlot> chunks(SlotIndex slot) noexcept;

 private:
  explicit SharedMap(std::byte* memory) noexcept;

  std::byte* memory_;
  SharedHeader* header_;
  SharedZone* zones_;
};

}  // namespace zonepack
