// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/bulk_chunk_builder.hpp"

#include <algorithm>

#include "platform/base/require.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

constexpr std::uint64_t kFrameBytes = 96;      // FlatBuffers' own offsets, lengths, padding
constexpr std::uint64_t kWorthCutting = 1024;  // less room is not worth cutting a table for
constexpr std::size_t kShared = 512;           // equal columns up to this size are stored once

std::size_t alignment_of(const EncodedColumn& column) {
  if (column.codec != fb::ColumnCodec::Raw) return 1;
  return column.param % 16 == 0 ? 16 : column.param % 4 == 0 ? 4 : 1;
}

std::size_t align_up(std::size_t value, std::size_t alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

std::string key_of(const EncodedColumn& column) {
  std::string key(reinterpret_cast<const char*>(column.bytes.data()), column.bytes.size());
  key += static_cast<char>(alignment_of(column));
  return key;
}

}  // namespace

std::uint64_t BulkChunkBuilder::size_with(std::size_t records, std::size_t columns,
                                          std::size_t bytes) const noexcept {
  return kFrameBytes + (records_.size() + records) * sizeof(fb::Record) +
         (columns_.size() + columns) * sizeof(fb::Column) + bytes_.size() + bytes + kColumnPadding;
}

std::uint64_t BulkChunkBuilder::size_with(const std::vector<EncodedColumn>& columns) const {
  std::size_t end = bytes_.size();
  for (const EncodedColumn& column : columns) {
    if (column.bytes.empty()) continue;
    if (column.bytes.size() <= kShared && places_.contains(key_of(column))) continue;
    end = align_up(end, alignment_of(column)) + column.bytes.size();
  }
  return size_with(1, columns.size(), end - bytes_.size());
}

BulkChunkBuilder::Added BulkChunkBuilder::add(const SourceTable& table, std::uint32_t first,
                                              std::uint64_t capacity, LatticeEncoder& lattice) {
  const std::uint32_t all = table.rows - first;
  std::uint64_t rows = table.rows_within(first, capacity);
  std::vector<EncodedColumn> columns =
      table.encode(first, static_cast<std::uint32_t>(rows), lattice);
  std::uint64_t size = size_with(columns);
  if (size <= capacity && rows == all) {
    append(table, first, all, columns);
    return {all, true};
  }
  const std::uint64_t used = size_with(1, columns.size(), 0);
  const std::uint64_t worth_cutting = table.of_blocks() ? 0 : kWorthCutting;
  if (all == 0 || used >= capacity || (!empty() && capacity - used < worth_cutting)) return {};
  while (size > capacity && rows > 0) {
    const std::uint64_t proportional =
        rows * (capacity - used) / std::max<std::uint64_t>(size - used, 1);
    rows = table.of_blocks() ? rows - 1 : std::min(proportional, rows - 1);
    if (rows == 0) break;
    columns = table.encode(first, static_cast<std::uint32_t>(rows), lattice);
    size = size_with(columns);
  }
  if (rows == 0) return {};
  append(table, first, static_cast<std::uint32_t>(rows), columns);
  return {static_cast<std::uint32_t>(rows), false};
}

void BulkChunkBuilder::append(const SourceTable& table, std::uint32_t first, std::uint32_t rows,
                              const std::vector<EncodedColumn>& columns) {
  records_.emplace_back(table.signature, table.ordinal, table.part, first, rows, table.rows,
                        static_cast<std::uint32_t>(columns_.size()),
                        static_cast<std::uint32_t>(columns.size()));
  for (const EncodedColumn& column : columns) {
    std::uint32_t place = 0;
    if (!column.bytes.empty()) {
      const std::size_t at = align_up(bytes_.size(), alignment_of(column));
      place = static_cast<std::uint32_t>(at);
      bool is_new = true;
      if (column.bytes.size() <= kShared) {
        const auto [found, inserted] = places_.emplace(key_of(column), place);
        place = found->second;
        is_new = inserted;
      }
      if (is_new) {
        bytes_.resize(at);
        bytes_.insert(bytes_.end(), column.bytes.begin(), column.bytes.end());
      }
    }
    columns_.emplace_back(column.base, place, static_cast<std::uint32_t>(column.bytes.size()),
                          column.param, column.field, column.codec, column.bits);
    if (column.codec == fb::ColumnCodec::Subset) needs_scan_ = true;
  }
  first_signature_ = std::min(first_signature_, table.signature);
  last_signature_ = std::max(last_signature_, table.signature);
}

Bytes BulkChunkBuilder::finish() {
  const std::uint64_t bound = size_bound();
  bytes_.resize(bytes_.size() + kColumnPadding);
  flatbuffers::FlatBufferBuilder builder(kSlotBytes + 1024);
  builder.ForceVectorAlignment(bytes_.size(), 1, 16);
  const auto bytes =
      builder.CreateVector(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
  const auto columns = builder.CreateVectorOfStructs(columns_);
  const auto records = builder.CreateVectorOfStructs(records_);
  fb::FinishBulkChunkBuffer(builder, fb::CreateBulkChunk(builder, records, columns, bytes));
  ZP_REQUIRE(builder.GetSize() <= bound);
  const auto* const begin = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  Bytes chunk(begin, begin + builder.GetSize());
  *this = BulkChunkBuilder();
  return chunk;
}

}  // namespace zonepack::packer
