// SPDX-License-Identifier: Apache-2.0
#include "runtime/client/table_rows.hpp"

#include <algorithm>

namespace zonepack {

const RecordView& record_with(const TableView& table, std::uint32_t row) noexcept {
  const auto records = table.records();
  const auto after = std::ranges::upper_bound(records, row, {}, &RecordView::first_row);
  return *(after - 1);
}

std::uint64_t TableRows::shape() const noexcept {
  if (!present()) return 0;
  const ColumnView shape = table_->attribute(fb::Field::Shape);
  return shape ? shape.base() : 0;
}

ByteSpan TableRows::row_of(const RecordView& record, std::uint32_t row, Buffer& buffer) noexcept {
  if (const ColumnView rows = record.column(fb::Field::Row)) {
    return rows.codec() == fb::ColumnCodec::Raw ? rows.raw_at(row) : ByteSpan();
  }
  std::size_t channels = 0;
  for (; channels < kMostChannels; ++channels) {
    const auto field =
        static_cast<fb::Field>(static_cast<std::size_t>(fb::Field::Channel0) + channels);
    const ColumnView channel = record.column(field);
    if (!channel) break;
    const std::uint32_t bits = channel.bits_at(row);
    std::memcpy(buffer.data() + channels * sizeof bits, &bits, sizeof bits);
  }
  return {buffer.data(), channels * 4};
}

ByteSpan TableRows::row_at(const TableView& table, std::uint32_t row, Buffer& buffer) noexcept {
  if (row >= table.total_rows()) return {};
  const RecordView& record = record_with(table, row);
  return row_of(record, row - record.first_row(), buffer);
}

}  // namespace zonepack
