// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"

namespace zonepack {

// Opens the pack of a zone. kMismatch when it is a whole pack, but not the one that the manifest
// names; with the detail kFalseClaim, or kTooLarge with the size of its index, when it is the one
// that the manifest names, but not as the manifest describes it: another zone, or another number of
// signatures, slots or chunks. `soon`: see PackReader::open().
inline constexpr std::int64_t kFalseClaim = 1;
Result<PackReader> open_pack(const Catalog& catalog, ZoneId zone, const PackReading& reading = {},
                             std::uint64_t soon = 0);

// Loads one zone, chunk by chunk, from its pack into slots: read into a private buffer, check,
// decode into place. Between two step() calls the load can be given up. One step waits for at most
// one window of at most kReadBufferBytes, holding the next chunk and those after it that fit.
//
// Threads: the loader's.
// Memory: the index and one read buffer, both counted in Catalog::fixed_bytes.
class ZoneLoad {
 public:
  // `slots` are the zone's, in placement order, kSlotBytes each; catalog.zones[zone].slots of them.
  // `read_buffer` has kReadBufferBytes.
  static Result<ZoneLoad> begin(const Catalog& catalog, ZoneId zone,
                                std::span<std::byte* const> slots, std::span<std::byte> read_buffer,
                                const PackReading& reading = kDefaultReadMode);

  // Loads the next chunk; false when there was none left. After an error the load is over.
  Result<bool> step();

  ByteCount stored_bytes_read() const noexcept { return stored_bytes_; }
  // Asked from storage so far: windows, header, index and tail.
  ByteCount bytes_fetched() const noexcept { return fetched_; }
  // Where the chunks loaded so far lie.
  const std::vector<ChunkRef>& chunks() const noexcept { return chunks_; }

 private:
  ZoneLoad(PackReader pack, PayloadMask mask, std::span<std::byte* const> slots,
           std::span<std::byte> read_buffer);

  Result<ByteSpan> stored(const fb::ChunkEntry& entry, std::byte* place);
  Result<ByteSpan> fetch(std::uint64_t from, std::size_t size, std::span<std::byte> buffer);
  void ask_ahead();
  bool wanted(const fb::ChunkEntry& entry) const noexcept {
    return (mask_ & mask_of(entry.kind())) != 0;
  }

  PackReader pack_;
  PayloadMask mask_;
  std::span<std::byte* const> slots_;
  std::span<std::byte> buffer_;
  ByteSpan window_;  // in the buffer: the file's bytes from window_from_ on
  std::uint64_t window_from_ = 0;
  std::uint32_t next_ = 0;
  std::uint32_t ahead_ = 0;    // wanted chunks before this one were asked for in advance ...
  ByteCount ahead_bytes_ = 0;  // ... and so many bytes of them were not yet read
  Placement placement_;
  ByteCount stored_bytes_ = 0;
  ByteCount fetched_;
  std::vector<ChunkRef> chunks_;
};

}  // namespace zonepack
