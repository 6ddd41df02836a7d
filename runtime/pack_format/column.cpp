// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/column.hpp"

#include <array>

#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack {
namespace {

std::uint64_t packed_bytes(std::uint64_t rows, unsigned bits) noexcept {
  return (rows * bits + 7) / 8;
}

std::uint32_t bits_from_ordered(fb::Field field, std::uint32_t ordered) noexcept {
  return is_integer(field) ? ordered ^ 0x80000000u : float_from_ordered(ordered);
}

bool blocks_are_sound(ByteSpan bytes, std::uint32_t rows) noexcept {
  const std::uint64_t blocks = (std::uint64_t{rows} + kBlockRows - 1) / kBlockRows;
  const std::uint64_t headers = blocks * sizeof(BlockHeader);
  if (headers > bytes.size()) return false;
  // Errors are accumulated, since an exit from every iteration would cost as much as the iteration.
  std::uint32_t words = 0;
  std::uint32_t elsewhere = 0;  // not 0: some block does not begin where the previous one ends
  std::uint32_t too_wide = 0;   // top bit: some block has more than 32 bits a row
  for (std::uint64_t i = 0; i < blocks; ++i) {
    BlockHeader header;
    std::memcpy(&header, bytes.data() + i * sizeof header, sizeof header);
    const std::uint32_t bits = header.bits | std::uint32_t{header.reserved} << 8;
    elsewhere |= header.offset ^ words;
    too_wide |= 32 - bits;
    words += bits;  // 32 rows of b bits are b words
  }
  return elsewhere == 0 && too_wide >> 31 == 0 &&
         headers + std::uint64_t{words} * 4 == bytes.size();
}

// Values are integers below 2^24 in size, which float32 holds exactly.
bool scale_is_sound(const fb::Column& column) noexcept {
  constexpr std::int64_t kFar = std::int64_t{1} << 24;
  const auto base = static_cast<std::int64_t>(column.base());
  return column.bits() <= 25 && column.param() <= 15 && base > -kFar && base < kFar;
}

bool lattice_is_sound(ByteSpan bytes, std::uint32_t rows) noexcept {
  LatticeHeader header;
  if (bytes.size() < sizeof header) return false;
  std::memcpy(&header, bytes.data(), sizeof header);
  const std::uint64_t cells = std::uint64_t{header.width} * header.height;
  constexpr std::int32_t kFar = 1 << 24;  // grid indices are exact in float32 below this
  return header.width < kFar && header.height < kFar && header.first_x > -kFar &&
         header.first_x < kFar && header.first_y > -kFar && header.first_y < kFar &&
         cells >= rows && bytes.size() - sizeof header == (cells + 7) / 8;
}

// Fields that a codec does not use are zero, and so are bits after the last row.
bool unused_is_zero(const ColumnView& column) noexcept {
  const auto codec = column.codec();
  const bool packed = codec == fb::ColumnCodec::Packed || codec == fb::ColumnCodec::Scaled;
  const bool has_param = codec == fb::ColumnCodec::Raw || codec == fb::ColumnCodec::Scaled ||
                         codec == fb::ColumnCodec::Planes;
  const bool has_base = codec != fb::ColumnCodec::Raw && codec != fb::ColumnCodec::Blocks &&
                        codec != fb::ColumnCodec::Lattice && codec != fb::ColumnCodec::Planes;
  if ((!packed && column.bits() != 0) || (!has_param && column.param() != 0) ||
      (!has_base && column.base() != 0) ||
      (codec == fb::ColumnCodec::Packed && column.base() >> 32 != 0)) {
    return false;
  }
  const std::uint64_t used = std::uint64_t{column.rows()} * column.bits() % 8;
  return !packed || used == 0 || std::to_integer<unsigned>(column.bytes().back()) >> used == 0;
}

std::uint64_t ones(ByteSpan bits) noexcept {
  std::uint64_t count = 0;
  for (const std::byte byte : bits) {
    count += static_cast<unsigned>(std::popcount(std::to_integer<std::uint8_t>(byte)));
  }
  return count;
}

constexpr unsigned bit_of(fb::ColumnCodec codec) { return 1u << static_cast<unsigned>(codec); }

// The codecs that a field may have, as bits, so that readers may use an accessor without asking.
constexpr std::uint8_t codecs_of(fb::Field field) {
  using fb::ColumnCodec;
  switch (field) {
    case fb::Field::Shape:
      return bit_of(ColumnCodec::Constant);
    case fb::Field::Info:
      return bit_of(ColumnCodec::Constant) | bit_of(ColumnCodec::Raw);
    case fb::Field::Descriptor:
      return bit_of(ColumnCodec::Raw);
    case fb::Field::Row:
      return bit_of(ColumnCodec::Raw) | bit_of(ColumnCodec::Lattice) | bit_of(ColumnCodec::Subset);
    case fb::Field::Voxels:
      return bit_of(ColumnCodec::Planes);
    default:
      return bit_of(ColumnCodec::Raw) | bit_of(ColumnCodec::Constant) |
             bit_of(ColumnCodec::Packed) | bit_of(ColumnCodec::Scaled) |
             bit_of(ColumnCodec::Blocks);
  }
}

constexpr std::size_t kFields = static_cast<std::size_t>(fb::Field::MAX) + 1;
constexpr auto kCodecs = [] {
  std::array<std::uint8_t, kFields> codecs{};
  for (std::size_t i = 0; i < kFields; ++i) codecs[i] = codecs_of(static_cast<fb::Field>(i));
  return codecs;
}();

bool codec_fits(const fb::Column& column) noexcept {
  const auto field = static_cast<std::size_t>(column.field());
  const auto codec = static_cast<unsigned>(column.codec());
  if (field >= kFields || codec > static_cast<unsigned>(fb::ColumnCodec::MAX) ||
      (kCodecs[field] >> codec & 1) == 0) {
    return false;
  }
  // of values, every row is one number
  const bool is_value = (kCodecs[field] & bit_of(fb::ColumnCodec::Packed)) != 0;
  return !is_value || column.codec() != fb::ColumnCodec::Raw || column.param() == 4;
}

// `room` is the length of the chunk's bytes without their padding. Inlined into the loop over
// columns, where a call for each would cost a fifth of the check.
[[gnu::always_inline]] inline bool is_sound(const fb::Column& column, const std::byte* bytes,
                                            std::uint64_t room, std::uint32_t rows) noexcept {
  const std::uint32_t size = column.size();
  if (column.offset() > room || size > room - column.offset()) return false;
  const fb::ColumnCodec codec = column.codec();
  if (codec == fb::ColumnCodec::Constant) return size == 0;
  if (codec == fb::ColumnCodec::Packed) {
    return column.bits() <= 32 && packed_bytes(rows, column.bits()) == size;
  }
  if (codec == fb::ColumnCodec::Scaled) {
    return scale_is_sound(column) && packed_bytes(rows, column.bits()) == size;
  }
  if (codec == fb::ColumnCodec::Raw) return std::uint64_t{rows} * column.param() == size;
  const ByteSpan own{bytes + column.offset(), size};
  if (codec == fb::ColumnCodec::Blocks) return blocks_are_sound(own, rows);
  if (codec == fb::ColumnCodec::Lattice) return lattice_is_sound(own, rows);
  if (codec == fb::ColumnCodec::Planes) return planes_are_sound(own, rows, column.param());
  const std::uint64_t span = column.base() >> 32;
  return codec == fb::ColumnCodec::Subset && span >= rows && size == (span + 7) / 8;
}

}  // namespace

std::uint32_t ColumnView::bits_at(std::uint32_t row) const noexcept {
  switch (column_->codec()) {
    case fb::ColumnCodec::Raw: {
      std::uint32_t bits;
      std::memcpy(&bits, data_ + std::size_t{row} * 4, sizeof bits);
      return bits;
    }
    case fb::ColumnCodec::Constant:
      return static_cast<std::uint32_t>(column_->base());
    case fb::ColumnCodec::Packed:
      return bits_from_ordered(field(), static_cast<std::uint32_t>(column_->base()) +
                                            packed_at(data_, row, column_->bits()));
    case fb::ColumnCodec::Scaled: {
      const auto value = static_cast<std::int64_t>(column_->base()) +
                         static_cast<std::int64_t>(packed_at(data_, row, column_->bits()));
      const float scale = 1.0F / static_cast<float>(1u << (column_->param() & 15));
      return std::bit_cast<std::uint32_t>(static_cast<float>(value) * scale);
    }
    case fb::ColumnCodec::Blocks: {
      const auto header =
          read_once<BlockHeader>(data_ + std::size_t{row / kBlockRows} * sizeof(BlockHeader));
      const std::size_t blocks = (std::size_t{rows_} + kBlockRows - 1) / kBlockRows;
      const std::size_t at = blocks * sizeof header + std::size_t{header.offset} * 4;
      const std::uint32_t last_word = (row % kBlockRows) * header.bits / 8;
      if (header.bits > 32 || at + last_word > column_->size()) return 0;  // changed since checked
      return bits_from_ordered(field(),
                               header.base + packed_at(data_ + at, row % kBlockRows, header.bits));
    }
    case fb::ColumnCodec::Lattice:
    case fb::ColumnCodec::Subset:
    case fb::ColumnCodec::Planes:
      break;
  }
  return 0;
}

bool column_is_sound(const fb::Column& column, ByteSpan bytes, std::uint32_t rows) noexcept {
  return bytes.size() >= kColumnPadding &&
         is_sound(column, bytes.data(), bytes.size() - kColumnPadding, rows);
}

bool columns_are_sound(std::span<const fb::Column> columns, ByteSpan bytes,
                       std::uint32_t rows) noexcept {
  if (bytes.size() < kColumnPadding) return columns.empty();
  const std::byte* const data = bytes.data();
  const std::uint64_t room = bytes.size() - kColumnPadding;
  for (const fb::Column& column : columns) {
    if (!codec_fits(column) ||
        !is_sound(column, data, room, is_attribute(column.field()) ? 1 : rows)) {
      return false;
    }
  }
  return true;
}

bool column_is_exact(const ColumnView& column) noexcept {
  if (!unused_is_zero(column)) return false;
  switch (column.codec()) {
    case fb::ColumnCodec::Lattice:
      return ones(column.bytes().subspan(sizeof(LatticeHeader))) == column.rows();
    case fb::ColumnCodec::Subset:
      return ones(column.bytes()) == column.rows();
    case fb::ColumnCodec::Planes:
      return planes_are_exact(column.bytes(), column.rows(), column.param());
    default:
      return true;
  }
}

}  // namespace zonepack
