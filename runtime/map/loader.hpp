// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/pack_reader.hpp"

namespace zonepack {

// Opens the pack of a zone. kMismatch when it is a whole pack, but not the one that the manifest
// names, or holds another zone or number of signatures or slots.
Result<PackReader> open_pack(const Catalog& catalog, ZoneId zone);

// Loads one zone, chunk by chunk, from its pack into slots: read into a private buffer, check,
// decode into place. Between two step() calls the load can be given up.
//
// Threads: the loader's. Memory: the index and one read buffer, both counted in
// Catalog::fixed_bytes.
class ZoneLoad {
 public:
  // `slots` are the zone's, in placement order, kSlotBytes each; catalog.zones[zone].slots of them.
  // `read_buffer` has kReadBufferBytes.
  static Result<ZoneLoad> begin(const Catalog& catalog, ZoneId zone,
                                std::span<std::byte* const> slots,
                                std::span<std::byte> read_buffer);

  // Loads the next chunk; false when there was none left. After an error the load is over.
  Result<bool> step();

  ByteCount stored_bytes_read() const noexcept { return stored_bytes_; }
  // Where the chunks loaded so far stand.
  const std::vector<ChunkRef>& chunks() const noexcept { return chunks_; }

 private:
  ZoneLoad(PackReader pack, PayloadMask mask, std::span<std::byte* const> slots,
           std::span<std::byte> read_buffer)
      : pack_(std::move(pack)), mask_(mask), slots_(slots), buffer_(read_buffer) {
    chunks_.reserve(pack_.index().chunks()->size());
  }

  Result<ByteSpan> stored(const fb::ChunkEntry& entry, std::byte* place);
  bool wanted(const fb::ChunkEntry& entry) const noexcept {
    return (mask_ & mask_of(entry.kind())) != 0;
  }

  PackReader pack_;
  PayloadMask mask_;
  std::span<std::byte* const> slots_;
  std::span<std::byte> buffer_;
  std::uint64_t buffered_from_ = 0;  // file offsets [from, to) stand in the buffer
  std::uint64_t buffered_to_ = 0;
  std::uint32_t next_ = 0;
  Placement placement_;
  ByteCount stored_bytes_ = 0;
  std::vector<ChunkRef> chunks_;
};

}  // namespace zonepack
