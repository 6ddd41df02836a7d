// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/zone_grant.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace zonepack {
namespace {

// An index entry to check a chunk against: of the loader's own entry, only the kind is known here.
fb::ChunkEntry entry_for(fb::PayloadKind kind, std::uint32_t first, std::uint32_t last) {
  const std::array<std::uint8_t, 16> digest{};
  return {0, 0, digest, 0, 0, first, last, 0, 0, 0, 0, kind, fb::ChunkCodec::Raw, 0, 0};
}

}  // namespace

Result<SharedTables> SharedTables::open(std::span<const std::byte> memory) {
  if (memory.size() < sizeof(SharedHeader)) return ErrorCode::kTruncated;
  const auto& header = *reinterpret_cast<const SharedHeader*>(memory.data());
  if (header.magic != kSharedMagic) return ErrorCode::kBadMagic;
  if (header.version != kSharedVersion) return {ErrorCode::kBadVersion, header.version};
  const auto zone_capacity = header.zone_capacity, slots = header.slot_count;
  std::atomic_signal_fence(std::memory_order_seq_cst);
  if (!shared_header_is_sound(header, memory.size())) return ErrorCode::kMismatch;
  const SharedPlaces at = shared_places(zone_capacity, slots);
  if (at.total != memory.size()) return ErrorCode::kMismatch;
  return SharedTables(memory.data(), at, zone_capacity, slots);
}

std::uint32_t SharedTables::zone_count() const noexcept {
  const auto& header = *reinterpret_cast<const SharedHeader*>(memory_);
  return std::min(zone_capacity_, header.zone_count.load(std::memory_order_acquire));
}

std::uint32_t SharedTables::epoch() const noexcept {
  return reinterpret_cast<const SharedHeader*>(memory_)->epoch.load(std::memory_order_acquire);
}

SlotIndex SharedTables::link(SlotIndex slot) const noexcept {
  return read_once<SlotIndex>(memory_ + at_.links + std::size_t{slot} * sizeof(SlotIndex));
}

SharedChunk SharedTables::chunk(SlotIndex slot, std::uint32_t index) const noexcept {
  const std::size_t place = std::size_t{slot} * kMaxChunksPerSlot + index;
  return read_once<SharedChunk>(memory_ + at_.chunks + place * sizeof(SharedChunk));
}

Result<std::unique_ptr<ZoneGrant>> ZoneGrant::make(const SharedTables& tables, ZoneId zone,
                                                   std::uint64_t state) {
  std::unique_ptr<ZoneGrant> grant(new ZoneGrant(zone, state));
  Result<void> made = grant->copy(tables);
  std::atomic_thread_fence(std::memory_order_acquire);
  if (tables.zone(zone).state.load(std::memory_order_relaxed) != state) {
    return ErrorCode::kCancelled;
  }
  if (made) made = grant->make_view();
  if (!made) return made.error();
  return grant;
}

Result<void> ZoneGrant::copy(const SharedTables& tables) {
  alignas(kChunkAlignment) std::array<std::byte, kSlotBytes> scratch;
  const std::uint32_t slots = tables.zone(zone_).slots.load(std::memory_order_relaxed);
  if (slots > tables.slot_count()) return ErrorCode::kMismatch;
  SlotIndex slot = tables.zone(zone_).head.load(std::memory_order_relaxed);
  for (std::uint32_t i = 0; i < slots; ++i, slot = tables.link(slot)) {
    if (slot >= tables.slot_count()) return ErrorCode::kMismatch;
    for (std::uint32_t n = 0; n < kMaxChunksPerSlot; ++n) {
      const SharedChunk chunk = tables.chunk(slot, n);
      const std::size_t offset = chunk.offset_lines * kChunkAlignment;
      if (chunk.bytes == 0) break;
      if (chunk.kind >= kPayloadKinds || chunk.bytes > kSlotBytes - offset) {
        return ErrorCode::kMismatch;
      }
      const std::byte* const in_slot = tables.slot(slot) + offset;
      std::memcpy(scratch.data(), in_slot, chunk.bytes);
      std::atomic_signal_fence(std::memory_order_seq_cst);
      const ByteSpan own(scratch.data(), chunk.bytes);
      const auto kind = static_cast<fb::PayloadKind>(chunk.kind);
      const Result<void> added =
          kind == fb::PayloadKind::Core ? add_core(own) : add_bulk(own, kind, in_slot);
      if (!added) return added;
    }
  }
  return {};
}

Result<void> ZoneGrant::add_core(ByteSpan chunk) {
  flatbuffers::Verifier verifier(reinterpret_cast<const std::uint8_t*>(chunk.data()), chunk.size(),
                                 4, 4096);
  if (!fb::VerifyCoreChunkBuffer(verifier)) return ErrorCode::kBadStructure;
  const fb::CoreChunk& there = *fb::GetCoreChunk(chunk.data());
  std::uint32_t last = there.first_signature();
  for (std::uint32_t i = 1; i < there.signatures()->size(); ++i) {
    if (!there.signatures()->Get(i)->continued()) ++last;
  }
  const auto entry = entry_for(fb::PayloadKind::Core, there.first_signature(), last);
  if (const Result<void> sound = check_core_chunk(chunk, entry); !sound) return sound;
  auto& own = core_bytes_.emplace_back(new std::byte[chunk.size()]);
  std::memcpy(own.get(), chunk.data(), chunk.size());
  cores_.push_back(fb::GetCoreChunk(own.get()));
  return {};
}

Result<void> ZoneGrant::add_bulk(ByteSpan chunk, fb::PayloadKind kind, const std::byte* in_slot) {
  if (const auto sound = check_bulk_chunk(chunk, entry_for(kind, 0, 0xFFFFFFFFu)); !sound) {
    return sound;
  }
  const fb::BulkChunk& there = *fb::GetBulkChunk(chunk.data());
  const auto* const bytes =
      in_slot + (reinterpret_cast<const std::byte*>(there.bytes()->data()) - chunk.data());
  for (const fb::Record* const record : *there.records()) {
    places_.push_back({columns_.size() + record->first_column(), bytes});
    records_.push_back(*record);
  }
  const auto* const columns = reinterpret_cast<const fb::Column*>(there.columns()->Data());
  columns_.insert(columns_.end(), columns, columns + there.columns()->size());
  return {};
}

Result<void> ZoneGrant::make_view() {
  std::vector<RecordView> records;
  records.reserve(records_.size());
  for (std::size_t i = 0; i < records_.size(); ++i) {
    records.emplace_back(records_[i], columns_.data() + places_[i].first_column, places_[i].bytes);
  }
  Result<ZoneView> view = ZoneView::make(cores_, std::move(records));
  if (!view) return view.error();
  view_.emplace(std::move(*view));
  return {};
}

}  // namespace zonepack
