// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "platform/base/byte_span.hpp"
#include "platform/base/result.hpp"
#include "runtime/pack_format/column.hpp"
#include "runtime/pack_format/core_chunk_generated.h"
#include "runtime/pack_format/pack_generated.h"

namespace zonepack {

inline constexpr std::uint32_t kPayloadKinds = 8;

// "core", "features", "scan" …; the words of --payload. Null for an unknown kind.
const char* to_string(fb::PayloadKind kind) noexcept;

// A set of payload kinds as bits; bit 0, the core, is always set.
using PayloadMask = std::uint32_t;
constexpr PayloadMask mask_of(fb::PayloadKind kind) noexcept {
  return 1u << static_cast<unsigned>(kind);
}
inline constexpr PayloadMask kCoreOnly = 1;
inline constexpr PayloadMask kEveryPayload = (1u << kPayloadKinds) - 1;
// What a robot needs of any kind of map; the default of memory.payload and of plan.
inline constexpr PayloadMask kDefaultPayload =
    kCoreOnly | mask_of(fb::PayloadKind::Features) | mask_of(fb::PayloadKind::Scan) |
    mask_of(fb::PayloadKind::Grid) | mask_of(fb::PayloadKind::Blocks);

// The kind whose payload a table of this part belongs to.
fb::PayloadKind kind_of(fb::Part part) noexcept;

// Checks everything that readers of a decoded chunk rely on: FlatBuffers structure, every record,
// every column's place and size, ordinals inside [first_signature, last_signature] of its index
// entry. Bounded: one pass over records and columns, no allocation. `bytes` must be aligned to 16.
Result<void> check_core_chunk(ByteSpan bytes, const fb::ChunkEntry& entry) noexcept;
Result<void> check_bulk_chunk(ByteSpan bytes, const fb::ChunkEntry& entry) noexcept;
Result<void> check_chunk(ByteSpan bytes, const fb::ChunkEntry& entry) noexcept;

// One record of a bulk chunk: rows of one table.
//
// Ownership: valid as long as the chunk's bytes.
// Real-time: no allocation; column() looks at no more than the record's columns.
// Threads: immutable.
class RecordView {
 public:
  RecordView(const fb::BulkChunk& chunk, std::uint32_t record) noexcept
      : record_(chunk.records()->Get(record)),
        columns_(reinterpret_cast<const fb::Column*>(chunk.columns()->Data()) +
                 record_->first_column()),
        bytes_(reinterpret_cast<const std::byte*>(chunk.bytes()->data())) {}
  // A record and its columns, copied out of a checked chunk whose bytes stay in place and may
  // change: values read later may be wrong, but no read leaves the chunk.
  RecordView(const fb::Record& record, const fb::Column* columns, const std::byte* bytes) noexcept
      : record_(&record), columns_(columns), bytes_(bytes) {}

  std::uint32_t signature() const noexcept { return record_->signature(); }
  fb::Part part() const noexcept { return record_->part(); }
  std::uint16_t ordinal() const noexcept { return record_->ordinal(); }
  std::uint32_t first_row() const noexcept { return record_->first_row(); }
  std::uint32_t rows() const noexcept { return record_->rows(); }
  std::uint32_t total_rows() const noexcept { return record_->total_rows(); }

  // An empty view when the record has no such column. Shape and Info count as one row.
  ColumnView column(fb::Field field) const noexcept;

 private:
  const fb::Record* record_;
  const fb::Column* columns_;  // the record's
  const std::byte* bytes_;     // the chunk's
};

}  // namespace zonepack
