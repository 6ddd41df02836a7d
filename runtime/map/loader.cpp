// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/loader.hpp"

#include <algorithm>

namespace zonepack {

Result<PackReader> open_pack(const Catalog& catalog, ZoneId zone, const PackReading& reading,
                             std::uint64_t soon) {
  const CatalogZone& wanted = catalog.zones[zone];
  PackReading bounded = reading;
  bounded.most_index_bytes = most_index_bytes(wanted.chunks);
  Result<PackReader> pack =
      PackReader::open(catalog.folder + "/" + wanted.pack, &wanted.pack_digest, bounded, soon);
  if (!pack) return pack.error();
  const fb::PackIndex& index = pack->index();
  if (index.zone()->str() != wanted.name || index.signatures() != wanted.signatures ||
      index.chunks()->size() != wanted.chunks ||
      slots_needed(index, catalog.payload) != wanted.slots) {
    return {ErrorCode::kMismatch, kFalseClaim};
  }
  return pack;
}

Result<ZoneLoad> ZoneLoad::begin(const Catalog& catalog, ZoneId zone,
                                 std::span<std::byte* const> slots,
                                 std::span<std::byte> read_buffer, const PackReading& reading) {
  // The chunks of the usual payload come first in a pack, and no chunk is stored in more bytes than
  // it decodes to.
  const std::uint64_t soon = std::uint64_t{catalog.zones[zone].slots} * kSlotBytes;
  Result<PackReader> pack = open_pack(catalog, zone, reading, soon);
  if (!pack) return pack.error();
  if (slots.size() < catalog.zones[zone].slots) {
    return {ErrorCode::kNoRoom, catalog.zones[zone].slots};
  }
  const PayloadMask mask = payload_closure(catalog.payload, pack->index().grid_needs_scan());
  return ZoneLoad(std::move(*pack), mask, slots, read_buffer);
}

ZoneLoad::ZoneLoad(PackReader pack, PayloadMask mask, std::span<std::byte* const> slots,
                   std::span<std::byte> read_buffer)
    : pack_(std::move(pack)),
      mask_(mask),
      slots_(slots),
      buffer_(read_buffer),
      fetched_(sizeof(PackHeader) + pack_.tail().index_size + sizeof(PackTail)) {
  const auto& all = *pack_.index().chunks();
  chunks_.reserve(all.size());
  for (; ahead_ < all.size(); ++ahead_) {
    const fb::ChunkEntry& entry = *all.Get(ahead_);
    if (entry.offset() + entry.stored_size() > pack_.front_asked()) break;
    if (wanted(entry)) ahead_bytes_ += entry.stored_size();
  }
}

// Asks for wanted chunks some way ahead of the window, so that the disk works while we decode.
void ZoneLoad::ask_ahead() {
  StorageFile& file = pack_.file();
  if (!file.reads_ahead()) return;
  const ByteCount most = file.most_ahead();
  if (ahead_ < next_) ahead_ = next_;
  if (ahead_bytes_ >= most / 4 * 3) return;
  const auto& all = *pack_.index().chunks();
  while (ahead_ < all.size() && ahead_bytes_ < most) {
    std::uint32_t end = ahead_;
    ByteCount run = 0;
    for (; end < all.size() && wanted(*all.Get(end)) && ahead_bytes_ + run < most; ++end) {
      run += all.Get(end)->stored_size();
    }
    if (run > 0 && !file.read_ahead(all.Get(ahead_)->offset(), run)) return;
    ahead_bytes_ += run;
    ahead_ = run > 0 ? end : ahead_ + 1;
  }
}

// Reads [from, from + size) into `buffer`.
Result<ByteSpan> ZoneLoad::fetch(std::uint64_t from, std::size_t size,
                                 std::span<std::byte> buffer) {
  ask_ahead();
  const Result<ByteSpan> window = pack_.file().read_window(from, size, buffer);
  if (!window) return window;
  fetched_ += size;
  ahead_bytes_ -= std::min<ByteCount>(ahead_bytes_, size);
  return window;
}

// Reads the stored bytes of the next chunk: into the buffer, together with those of the wanted
// chunks that follow it in the file and fit; or, for a raw chunk that may start anywhere, straight
// into `place`.
Result<ByteSpan> ZoneLoad::stored(const fb::ChunkEntry& entry, std::byte* place) {
  const std::uint64_t from = entry.offset();
  const std::uint64_t end = from + entry.stored_size();
  if (window_from_ <= from && end <= window_from_ + window_.size()) {
    return window_.subspan(static_cast<std::size_t>(from - window_from_), entry.stored_size());
  }
  const auto in_place = [](const fb::ChunkEntry& chunk) {
    return chunk.codec() == fb::ChunkCodec::Raw;
  };
  if (in_place(entry)) return fetch(from, entry.stored_size(), {place, entry.stored_size()});
  const auto& all = *pack_.index().chunks();
  std::uint64_t to = end;
  for (std::uint32_t i = next_ + 1; i < all.size(); ++i) {
    const fb::ChunkEntry& more = *all.Get(i);
    if (!wanted(more) || in_place(more) || to + more.stored_size() - from > buffer_.size()) break;
    to += more.stored_size();
  }
  const Result<ByteSpan> window = fetch(from, static_cast<std::size_t>(to - from), buffer_);
  if (!window) return window;
  window_ = *window;
  window_from_ = from;
  return window_.first(entry.stored_size());
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
