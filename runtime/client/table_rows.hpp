// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "runtime/pack_format/zone_view.hpp"

namespace zonepack {

// The rows of one table of a signature: points of a scan, cells of a grid, bytes of an image. Empty
// when the signature has no such table or its payload was not loaded. Valid as long as the view.
class TableRows {
 public:
  static constexpr std::size_t kMostChannels = 10;
  using Buffer = std::array<std::byte, kMostChannels * 4>;

  TableRows() = default;
  // `scan`: of the same signature; the rows of a grid may refer to its points. May be null.
  explicit TableRows(const TableView* table, const TableView* scan = nullptr) noexcept
      : table_(table), scan_(scan) {}

  bool present() const noexcept { return table_ != nullptr; }
  std::uint32_t size() const noexcept { return present() ? table_->total_rows() : 0; }

  // The element type of the source's matrix as OpenCV numbers them (depth = type & 7, channels =
  // (type >> 3) + 1), and its rows; 0 where the table is not a matrix.
  std::int32_t matrix_type() const noexcept { return static_cast<std::int32_t>(shape() >> 32); }
  std::int32_t matrix_rows() const noexcept { return static_cast<std::int32_t>(shape()); }

  // Calls fn(ByteSpan) for every row, in order. A row lies in the slot or in a buffer that the next
  // row overwrites.
  template <typename Fn>
  void for_each(Fn&& fn) const {
    if (!present()) return;
    Buffer buffer;
    for (const RecordView& record : table_->records()) {
      const ColumnView rows = record.column(fb::Field::Row);
      if (!rows || rows.codec() == fb::ColumnCodec::Raw) {
        for (std::uint32_t i = 0; i < record.rows(); ++i) fn(row_of(record, i, buffer));
      } else if (rows.codec() == fb::ColumnCodec::Lattice) {
        for_each_cell(rows, [&](float x, float y) {
          const std::array<float, 2> cell{x, y};
          fn(ByteSpan(std::as_bytes(std::span(cell))));
        });
      } else {
        for_each_scan_index(rows, [&](std::uint32_t index) {
          fn(scan_ == nullptr ? ByteSpan() : row_at(*scan_, index, buffer));
        });
      }
    }
  }

  // Calls fn(std::span<const float>) for every row that consists of at most 10 floats.
  template <typename Fn>
  void for_each_point(Fn&& fn) const {
    std::array<float, kMostChannels> values;
    for_each([&](ByteSpan row) {
      if (row.size() > sizeof values || row.size() % sizeof(float) != 0 || row.empty()) return;
      std::memcpy(values.data(), row.data(), row.size());
      fn(std::span<const float>(values.data(), row.size() / sizeof(float)));
    });
  }

  // Calls fn(ByteSpan) with pieces of a table of bytes (an image), in order, where they lie.
  template <typename Fn>
  void for_each_piece(Fn&& fn) const {
    if (!present()) return;
    for (const RecordView& record : table_->records()) {
      const ColumnView rows = record.column(fb::Field::Row);
      if (rows && rows.codec() == fb::ColumnCodec::Raw) fn(rows.bytes());
    }
  }

 private:
  std::uint64_t shape() const noexcept;
  // Row `row` of a record whose rows are raw or channels; else empty.
  static ByteSpan row_of(const RecordView& record, std::uint32_t row, Buffer& buffer) noexcept;
  static ByteSpan row_at(const TableView& table, std::uint32_t row, Buffer& buffer) noexcept;

  const TableView* table_ = nullptr;
  const TableView* scan_ = nullptr;
};

// The record of a table that holds a row below total_rows(). Takes log2(records) steps.
const RecordView& record_with(const TableView& table, std::uint32_t row) noexcept;

}  // namespace zonepack
