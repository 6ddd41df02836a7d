// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "platform/base/byte_span.hpp"
#include "runtime/pack_format/bulk_chunk_generated.h"
#include "runtime/pack_format/limits.hpp"

// Columns of 32-bit values in the smallest form that restores every bit; each value is read in
// place in O(1). Values are kept in an order-preserving unsigned form, so that neighbours in value
// are neighbours in bits.
namespace zonepack {

// Rows of a Blocks column that share one base and one width.
inline constexpr std::uint32_t kBlockRows = 32;

struct BlockHeader {
  std::uint32_t base;     // ordered form
  std::uint16_t offset;   // of the block's bits, in 4-byte words after the last header
  std::uint8_t bits;      // 0..32
  std::uint8_t reserved;  // 0
};
static_assert(sizeof(BlockHeader) == 8);

// Cells of a regular grid: coordinate = float(index) * cell + origin, two roundings. A bitmap of
// width x height follows, least significant bit first, x fastest; set bits are the rows, in order.
struct LatticeHeader {
  float cell, origin_x, origin_y;
  std::int32_t first_x, first_y;  // grid index of bit 0
  std::uint32_t width, height;
};
static_assert(sizeof(LatticeHeader) == 28);

// Signed integers and floats as unsigned integers in the same order.
constexpr std::uint32_t ordered_from_int(std::uint32_t bits) noexcept { return bits ^ 0x80000000u; }
constexpr std::uint32_t ordered_from_float(std::uint32_t bits) noexcept {
  return bits ^ ((bits >> 31) != 0 ? 0xFFFFFFFFu : 0x80000000u);
}
constexpr std::uint32_t float_from_ordered(std::uint32_t ordered) noexcept {
  return ordered ^ ((ordered >> 31) != 0 ? 0x80000000u : 0xFFFFFFFFu);
}

constexpr bool is_integer(fb::Field field) noexcept {
  return field == fb::Field::WordId || field == fb::Field::Octave || field == fb::Field::Place ||
         field == fb::Field::SourceRow;
}

// Attributes belong to the whole table instead of its rows: one row in the first record.
constexpr bool is_attribute(fb::Field field) noexcept {
  return field == fb::Field::Shape || field == fb::Field::Info;
}

// Bits [index * width, (index + 1) * width) of a little-endian bit string; width 0..32. Reads up to
// kColumnPadding bytes past the last bit.
inline std::uint32_t packed_at(const std::byte* bytes, std::uint32_t index,
                               unsigned width) noexcept {
  const std::uint64_t bit = std::uint64_t{index} * width;
  std::uint64_t word;
  std::memcpy(&word, bytes + (bit >> 3), sizeof word);
  return static_cast<std::uint32_t>((word >> (bit & 7)) & ((std::uint64_t{1} << width) - 1));
}

// Reads a value from bytes that another process may change meanwhile: keeps the compiler from
// reading them again after the value has been checked.
template <typename T>
T read_once(const std::byte* from) noexcept {
  T value;
  std::memcpy(&value, from, sizeof value);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  return value;
}

// One column of one record, read in place. RecordView makes it from validated columns only; their
// bytes may change later, which makes values wrong, but no read leaves the column.
//
// Real-time: every access is O(1), no allocation.
// Threads: immutable.
class ColumnView {
 public:
  ColumnView() = default;
  ColumnView(const fb::Column& column, const std::byte* bytes, std::uint32_t rows) noexcept
      : column_(&column), data_(bytes + column.offset()), rows_(rows) {}

  explicit operator bool() const noexcept { return column_ != nullptr; }
  fb::Field field() const noexcept { return column_->field(); }
  fb::ColumnCodec codec() const noexcept { return column_->codec(); }
  std::uint64_t base() const noexcept { return column_->base(); }
  std::uint32_t param() const noexcept { return column_->param(); }
  unsigned bits() const noexcept { return column_->bits(); }
  std::uint32_t rows() const noexcept { return rows_; }
  ByteSpan bytes() const noexcept { return {data_, column_->size()}; }

  // The 32 bits of a row. For Raw columns of 4 bytes a row, Constant, Packed, Scaled and Blocks.
  std::uint32_t bits_at(std::uint32_t row) const noexcept;
  float float_at(std::uint32_t row) const noexcept { return std::bit_cast<float>(bits_at(row)); }
  std::int32_t int_at(std::uint32_t row) const noexcept {
    return static_cast<std::int32_t>(bits_at(row));
  }

  // A Raw column's row: param() bytes.
  ByteSpan raw_at(std::uint32_t row) const noexcept {
    return {data_ + std::size_t{row} * column_->param(), column_->param()};
  }

 private:
  const fb::Column* column_ = nullptr;
  const std::byte* data_ = nullptr;
  std::uint32_t rows_ = 0;
};

// Calls fn(x_m, y_m) for every row of a Lattice column, in order. At most rows() calls.
template <typename Fn>
void for_each_cell(const ColumnView& column, Fn&& fn) {
  const auto header = read_once<LatticeHeader>(column.bytes().data());
  const std::byte* const bitmap = column.bytes().data() + sizeof header;
  const std::uint64_t bits = (column.bytes().size() - sizeof header) * 8;
  if (header.width == 0 || header.height > bits / header.width) return;  // changed since checked
  std::uint32_t left = column.rows();
  for (std::uint32_t row = 0; row < header.height && left != 0; ++row) {
    const float y =
        static_cast<float>(std::int64_t{header.first_y} + row) * header.cell + header.origin_y;
    for (std::uint32_t col = 0; col < header.width && left != 0; ++col) {
      const std::uint64_t bit = std::uint64_t{row} * header.width + col;
      if ((std::to_integer<unsigned>(bitmap[bit >> 3]) >> (bit & 7) & 1) == 0) continue;
      --left;
      const float x =
          static_cast<float>(std::int64_t{header.first_x} + col) * header.cell + header.origin_x;
      fn(x, y);
    }
  }
}

// Calls fn(index) for every row of a Subset column: indices of scan points, ascending.
template <typename Fn>
void for_each_scan_index(const ColumnView& column, Fn&& fn) {
  const auto first = static_cast<std::uint32_t>(column.base());
  const auto span = static_cast<std::uint32_t>(column.base() >> 32);
  std::uint32_t left = column.rows();
  for (std::uint32_t i = 0; i < span && left != 0; ++i) {
    if ((std::to_integer<unsigned>(column.bytes()[i >> 3]) >> (i & 7) & 1) == 0) continue;
    --left;
    fn(first + i);
  }
}

// Whether the column's size, width and parameters fit its codec and row count, so that no accessor
// above reads outside column bytes plus kColumnPadding. `bytes` are the chunk's.
bool column_is_sound(const fb::Column& column, ByteSpan bytes, std::uint32_t rows) noexcept;

// The same for all columns of a record, and whether each has a codec that its field may have.
bool columns_are_sound(std::span<const fb::Column> columns, ByteSpan bytes,
                       std::uint32_t rows) noexcept;

// Whether bit strings hold exactly the declared rows, and everything that the codec does not use is
// zero. Takes a pass over the column; for verify.
bool column_is_exact(const ColumnView& column) noexcept;

}  // namespace zonepack
