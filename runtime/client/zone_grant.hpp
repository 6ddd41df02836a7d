// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/memory/shared_layout.hpp"
#include "runtime/pack_format/zone_view.hpp"

namespace zonepack {

// The tables of the shared memory, whose places were checked once against its size and are not read
// again.
// Threads: any.
class SharedTables {
 public:
  // `memory` is aligned to 64 and stays mapped. kMismatch: not laid out as this version expects.
  static Result<SharedTables> open(std::span<const std::byte> memory);

  std::uint32_t zone_capacity() const noexcept { return zone_capacity_; }
  std::uint32_t zone_count() const noexcept;  // of the map in use
  std::uint32_t epoch() const noexcept;
  std::uint32_t slot_count() const noexcept { return slot_count_; }

  // `zone` is below zone_capacity().
  const SharedZone& zone(ZoneId zone) const noexcept {
    return reinterpret_cast<const SharedZone*>(memory_ + at_.zones)[zone];
  }
  // `slot` is below slot_count().
  SlotIndex link(SlotIndex slot) const noexcept;
  SharedChunk chunk(SlotIndex slot, std::uint32_t index) const noexcept;
  const std::byte* slot(SlotIndex slot) const noexcept {
    return memory_ + at_.slots + std::size_t{slot} * kSlotBytes;
  }

 private:
  SharedTables(const std::byte* memory, const SharedPlaces& at, std::uint32_t zone_capacity,
               std::uint32_t slot_count) noexcept
      : memory_(memory), at_(at), zone_capacity_(zone_capacity), slot_count_(slot_count) {}

  const std::byte* memory_;
  SharedPlaces at_;
  std::uint32_t zone_capacity_;
  std::uint32_t slot_count_;
};

// What a reader needs of one load of a zone before it may read in place: every offset, count and
// core record, copied into private memory and checked there. Whatever happens to the slots later,
// view() reads inside them and inside these copies.
//
// Each chunk is copied once and examined only in the copy. Costs a pass over the zone's slots, and
// the memory of its core chunks, records and columns; kept for as long as the zone stays loaded.
class ZoneGrant {
 public:
  // `state` is the zone's, not 0. kCancelled: the zone was withdrawn meanwhile. kBadStructure,
  // kMismatch: what was published is broken, so no working zoned wrote it.
  static Result<std::unique_ptr<ZoneGrant>> make(const SharedTables& tables, ZoneId zone,
                                                 std::uint64_t state);
  ZoneGrant(const ZoneGrant&) = delete;
  ZoneGrant& operator=(const ZoneGrant&) = delete;

  ZoneId zone() const noexcept { return zone_; }
  std::uint64_t state() const noexcept { return state_; }
  const ZoneView& view() const noexcept { return *view_; }

 private:
  // A record among records_ whose columns and bytes are known when all chunks are copied.
  struct Place {
    std::size_t first_column;
    const std::byte* bytes;
  };

  ZoneGrant(ZoneId zone, std::uint64_t state) : zone_(zone), state_(state) {}
  Result<void> copy(const SharedTables& tables);
  Result<void> add_core(ByteSpan chunk);
  Result<void> add_bulk(ByteSpan chunk, fb::PayloadKind kind, const std::byte* in_slot);
  Result<void> make_view();

  ZoneId zone_;
  std::uint64_t state_;
  std::vector<std::unique_ptr<std::byte[]>> core_bytes_;
  std::vector<const fb::CoreChunk*> cores_;
  std::vector<fb::Record> records_;
  std::vector<Place> places_;  // one for each record
  std::vector<fb::Column> columns_;
  std::optional<ZoneView> view_;
};

}  // namespace zonepack
