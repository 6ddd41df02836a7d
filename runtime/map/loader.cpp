// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/loader.hpp"

namespace zonepack {

Result<PackReader> open_pack(const Catalog& catalog, ZoneId zone) {
  const CatalogZone& wanted = catalog.zones[zone];
  Result<PackReader> pack =
      PackReader::open(catalog.folder + "/" + wanted.pack, &wanted.pack_digest);
  if (!pack) return pack.error();
  const fb::PackIndex& index = pack->index();
  if (index.zone()->str() != wanted.name || index.signatures() != wanted.signatures ||
      slots_needed(index, catalog.payload) != wanted.slots) {
    return ErrorCode::kMismatch;
  }
  return pack;
}

Result<ZoneLoad> ZoneLoad::begin(const Catalog& catalog, ZoneId zone,
                                 std::span<std::byte* const> slots,
                                 std::span<std::byte> read_buffer) {
  Result<PackReader> pack = open_pack(catalog, zone);
  if (!pack) return pack.error();
  if (slots.size() < catalog.zones[zone].slots) {
    return {ErrorCode::kNoRoom, catalog.zones[zone].slots};
  }
  const PayloadMask mask = payload_closure(catalog.payload, pack->index().grid_needs_scan());
  return ZoneLoad(std::move(*pack), mask, slots, read_buffer);
}

// Reads a raw chunk into its place. Before others, reads ahead as many wanted chunks as follow each
// other, are compressed and fit the buffer.
Result<ByteSpan> ZoneLoad::stored(const fb::ChunkEntry& entry, std::byte* place) {
  if (entry.codec() == fb::ChunkCodec::Raw) {
    const std::span<std::byte> out(place, entry.stored_size());
    if (const auto read = pack_.file().read_at(entry.offset(), out); !read) return read.error();
    return ByteSpan(out);
  }
  const std::uint64_t end = entry.offset() + entry.stored_size();
  if (entry.offset() < buffered_from_ || end > buffered_to_) {
    std::uint64_t to = end;
    const auto& all = *pack_.index().chunks();
    for (std::uint32_t i = next_ + 1; i < all.size() && wanted(*all.Get(i)); ++i) {
      if (all.Get(i)->codec() == fb::ChunkCodec::Raw) break;
      const std::uint64_t more = to + all.Get(i)->stored_size();
      if (more - entry.offset() > buffer_.size()) break;
      to = more;
    }
    const auto out = buffer_.first(to - entry.offset());
    if (const auto read = pack_.file().read_at(entry.offset(), out); !read) return read.error();
    buffered_from_ = entry.offset();
    buffered_to_ = to;
  }
  return ByteSpan(buffer_.subspan(entry.offset() - buffered_from_, entry.stored_size()));
}

Result<bool> ZoneLoad::step() {
  const auto& all = *pack_.index().chunks();
  while (next_ < all.size() && !wanted(*all.Get(next_))) ++next_;
  if (next_ == all.size()) return false;
  const fb::ChunkEntry& entry = *all.Get(next_);
  const Placement::Place place = placement_.add(entry.decoded_size());
  std::byte* const out = slots_[place.slot] + place.offset;
  const Result<ByteSpan> bytes = stored(entry, out);
  if (!bytes) return bytes.error();
  const Result<ByteSpan> chunk = decode_chunk(entry, *bytes, out);
  if (!chunk) return chunk.error();
  chunks_.push_back({entry.kind(), *chunk});
  stored_bytes_ += entry.stored_size();
  ++next_;
  return true;
}

}  // namespace zonepack
