// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/column_encoder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "packer/encode/bit_writer.hpp"
#include "runtime/pack_format/column.hpp"

namespace zonepack::packer {
namespace {

unsigned width_of(std::uint32_t range) { return static_cast<unsigned>(std::bit_width(range)); }

std::uint32_t ordered(fb::Field field, std::uint32_t bits) {
  return is_integer(field) ? ordered_from_int(bits) : ordered_from_float(bits);
}

std::uint64_t packed_size(std::size_t rows, unsigned bits) {
  return (std::uint64_t{rows} * bits + 7) / 8;
}

// The smallest fraction such that every float is exactly k / 2^fraction with |k| < 2^24, if any.
std::optional<unsigned> fraction_bits(std::span<const std::uint32_t> values) {
  constexpr unsigned kMost = 8;
  unsigned fraction = 0;
  for (const std::uint32_t bits : values) {
    const float value = std::bit_cast<float>(bits);
    if (bits == 0x80000000u || !(std::abs(value) < 65536.0F)) return std::nullopt;
    while (std::trunc(value * static_cast<float>(1u << fraction)) !=
           value * static_cast<float>(1u << fraction)) {
      if (++fraction > kMost) return std::nullopt;
    }
  }
  return fraction;
}

void append(Bytes& out, const void* data, std::size_t size) {
  const auto* const bytes = static_cast<const std::byte*>(data);
  out.insert(out.end(), bytes, bytes + size);
}

EncodedColumn encode_blocks(fb::Field field, std::span<const std::uint32_t> in_order) {
  EncodedColumn column{field, fb::ColumnCodec::Blocks, 0, 0, 0, {}};
  std::uint16_t offset = 0;
  Bytes bits;
  BitWriter writer(bits);
  for (std::size_t begin = 0; begin < in_order.size(); begin += kBlockRows) {
    const auto block =
        in_order.subspan(begin, std::min<std::size_t>(kBlockRows, in_order.size() - begin));
    const auto [least, most] = std::minmax_element(block.begin(), block.end());
    const unsigned width = width_of(*most - *least);
    const BlockHeader header{*least, offset, static_cast<std::uint8_t>(width), 0};
    append(column.bytes, &header, sizeof header);
    for (std::size_t i = 0; i < kBlockRows; ++i) {
      writer.put(i < block.size() ? block[i] - *least : 0, width);
    }
    offset = static_cast<std::uint16_t>(offset + width);
  }
  writer.finish();
  append(column.bytes, bits.data(), bits.size());
  return column;
}

std::uint64_t blocks_size(std::span<const std::uint32_t> in_order) {
  std::uint64_t size = 0;
  for (std::size_t begin = 0; begin < in_order.size(); begin += kBlockRows) {
    const auto block =
        in_order.subspan(begin, std::min<std::size_t>(kBlockRows, in_order.size() - begin));
    const auto [least, most] = std::minmax_element(block.begin(), block.end());
    size += sizeof(BlockHeader) + std::size_t{4} * width_of(*most - *least);
  }
  return size;
}

}  // namespace

EncodedColumn encode_constant(fb::Field field, std::uint64_t value) {
  return {field, fb::ColumnCodec::Constant, 0, 0, value, {}};
}

EncodedColumn encode_raw(fb::Field field, std::span<const std::byte> bytes,
                         std::uint32_t row_bytes) {
  return {field, fb::ColumnCodec::Raw, 0, row_bytes, 0, Bytes(bytes.begin(), bytes.end())};
}

EncodedColumn encode_values(fb::Field field, std::span<const std::uint32_t> values) {
  if (values.empty()) return encode_constant(field, 0);
  if (std::all_of(values.begin(), values.end(), [&](auto v) { return v == values[0]; })) {
    return encode_constant(field, values[0]);
  }
  std::vector<std::uint32_t> in_order(values.size());
  std::transform(values.begin(), values.end(), in_order.begin(),
                 [&](std::uint32_t v) { return ordered(field, v); });
  const auto [least, most] = std::minmax_element(in_order.begin(), in_order.end());
  const std::uint32_t base = *least;
  const unsigned packed_width = width_of(*most - base);

  std::optional<unsigned> fraction;
  std::int64_t scaled_base = 0;
  unsigned scaled_width = 33;
  std::vector<std::int64_t> scaled;
  if (!is_integer(field) && (fraction = fraction_bits(values))) {
    scaled.reserve(values.size());
    for (const std::uint32_t bits : values) {
      scaled.push_back(static_cast<std::int64_t>(std::bit_cast<float>(bits) *
                                                 static_cast<float>(1u << *fraction)));
    }
    const auto [low, high] = std::minmax_element(scaled.begin(), scaled.end());
    scaled_base = *low;
    scaled_width = width_of(static_cast<std::uint32_t>(*high - *low));
  }

  const std::uint64_t raw = 4 * values.size();
  const std::uint64_t by_packed = packed_size(values.size(), packed_width);
  const std::uint64_t by_scaled =
      scaled_width > 32 ? raw : packed_size(values.size(), scaled_width);
  const std::uint64_t by_blocks = blocks_size(in_order);
  const std::uint64_t best = std::min({raw, by_packed, by_scaled, by_blocks});
  if (best == raw) {
    return encode_raw(field, std::as_bytes(values), 4);
  }
  if (best == by_scaled) {
    EncodedColumn column{field,
                         fb::ColumnCodec::Scaled,
                         static_cast<std::uint8_t>(scaled_width),
                         *fraction,
                         static_cast<std::uint64_t>(scaled_base),
                         {}};
    BitWriter writer(column.bytes);
    for (const std::int64_t v : scaled) {
      writer.put(static_cast<std::uint32_t>(v - scaled_base), scaled_width);
    }
    writer.finish();
    return column;
  }
  if (best == by_packed) {
    EncodedColumn column{
        field, fb::ColumnCodec::Packed, static_cast<std::uint8_t>(packed_width), 0, base, {}};
    BitWriter writer(column.bytes);
    for (const std::uint32_t v : in_order) writer.put(v - base, packed_width);
    writer.finish();
    return column;
  }
  return encode_blocks(field, in_order);
}

namespace {

constexpr std::int32_t kFarIndex = 1 << 23;

// The grid index of a coordinate, if the grid reproduces exactly that coordinate.
std::optional<std::int32_t> index_on(float value, float cell, float origin) {
  const double estimate = (static_cast<double>(value) - origin) / cell;
  if (!(std::abs(estimate) < kFarIndex)) return std::nullopt;
  const auto index = static_cast<std::int32_t>(std::lround(estimate));
  const float back = static_cast<float>(index) * cell + origin;
  if (std::bit_cast<std::uint32_t>(back) != std::bit_cast<std::uint32_t>(value))
    return std::nullopt;
  return index;
}

// Finds the indices of a sequence of coordinates. Most equal the previous index or the one after
// it; these are tried first where no two indices can share a coordinate.
class IndexFinder {
 public:
  IndexFinder(float cell, float origin) : cell_(cell), origin_(origin) {
    constexpr float kExact = 1 << 20;  // at this many cells a coordinate is exact to 1/8 cell
    limit_ = std::abs(origin) < cell * kExact ? cell * kExact : 0;
  }

  std::optional<std::int32_t> operator()(float value) {
    if (std::abs(value) < limit_ && last_) {
      if (is(value, *last_)) return last_;
      if (is(value, *last_ + 1)) return last_ = *last_ + 1;
    }
    return last_ = index_on(value, cell_, origin_);
  }

 private:
  bool is(float value, std::int32_t index) const {
    const float back = static_cast<float>(index) * cell_ + origin_;
    return std::bit_cast<std::uint32_t>(back) == std::bit_cast<std::uint32_t>(value);
  }

  float cell_, origin_, limit_;
  std::optional<std::int32_t> last_;
};

bool origin_fits(std::span<const float> distinct, float cell, float origin) {
  return std::all_of(distinct.begin(), distinct.end(),
                     [&](float v) { return index_on(v, cell, origin).has_value(); });
}

std::vector<float> distinct_of(std::span<const float> cells, std::size_t axis) {
  std::vector<float> values;
  for (std::size_t i = axis; i < cells.size(); i += 2) {
    if (!std::isfinite(cells[i])) return {};
    values.push_back(cells[i]);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// Searches for the grid's origin: it lies a whole number of cells below the smallest coordinate, up
// to rounding.
std::optional<float> find_origin(std::span<const float> distinct, float cell) {
  constexpr int kFarthest = 2048;
  constexpr int kUlps = 3;
  for (int steps = 0; steps < kFarthest; ++steps) {
    const float near = distinct.front() - static_cast<float>(steps) * cell;
    float candidate = near;
    for (int i = 0; i < kUlps; ++i) candidate = std::nextafter(candidate, -INFINITY);
    for (int i = -kUlps; i <= kUlps; ++i) {
      if (origin_fits(distinct, cell, candidate)) return candidate;
      candidate = std::nextafter(candidate, INFINITY);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<EncodedColumn> LatticeEncoder::encode(std::span<const std::byte> cells,
                                                    float cell_size) {
  const std::size_t rows = cells.size() / 8;
  if (rows == 0 || !(cell_size > 0) || !std::isfinite(cell_size)) return std::nullopt;
  std::vector<float> values(rows * 2);
  std::memcpy(values.data(), cells.data(), rows * 8);

  std::vector<std::int32_t> ix(rows), iy(rows);
  const auto place = [&] {
    if (!origin_x_ || !origin_y_) return false;
    IndexFinder index_x(cell_size, *origin_x_), index_y(cell_size, *origin_y_);
    for (std::size_t i = 0; i < rows; ++i) {
      const auto x = index_x(values[2 * i]);
      const auto y = index_y(values[2 * i + 1]);
      if (!x || !y) return false;
      ix[i] = *x;
      iy[i] = *y;
    }
    return true;
  };
  if (!place()) {
    const std::vector<float> xs = distinct_of(values, 0);
    const std::vector<float> ys = distinct_of(values, 1);
    if (xs.empty() || ys.empty()) return std::nullopt;
    origin_x_ = find_origin(xs, cell_size);
    if (origin_x_) origin_y_ = find_origin(ys, cell_size);
    if (!place()) return std::nullopt;
  }
  for (std::size_t i = 1; i < rows; ++i) {
    if (iy[i] < iy[i - 1] || (iy[i] == iy[i - 1] && ix[i] <= ix[i - 1])) return std::nullopt;
  }
  const auto [left, right] = std::minmax_element(ix.begin(), ix.end());
  LatticeHeader header{cell_size, *origin_x_, *origin_y_, *left, iy.front(), 0, 0};
  header.width = static_cast<std::uint32_t>(*right - *left + 1);
  header.height = static_cast<std::uint32_t>(iy.back() - iy.front() + 1);
  const std::uint64_t bitmap_bytes = (std::uint64_t{header.width} * header.height + 7) / 8;
  if (bitmap_bytes + sizeof header >= cells.size()) return std::nullopt;
  const auto bitmap = static_cast<std::size_t>(bitmap_bytes);

  EncodedColumn column{fb::Field::Row, fb::ColumnCodec::Lattice, 0, 0, 0, {}};
  append(column.bytes, &header, sizeof header);
  column.bytes.resize(sizeof header + bitmap);
  for (std::size_t i = 0; i < rows; ++i) {
    const auto bit = static_cast<std::size_t>(iy[i] - header.first_y) * header.width +
                     static_cast<std::size_t>(ix[i] - header.first_x);
    column.bytes[sizeof header + bit / 8] |= static_cast<std::byte>(1u << (bit % 8));
  }
  return column;
}

std::optional<std::vector<std::uint32_t>> subset_of(std::span<const std::byte> rows,
                                                    std::span<const std::byte> scan,
                                                    std::size_t row_bytes) {
  std::vector<std::uint32_t> indices;
  const std::size_t points = scan.size() / row_bytes;
  std::size_t next = 0;
  for (std::size_t at = 0; at < rows.size(); at += row_bytes, ++next) {
    while (next < points &&
           std::memcmp(rows.data() + at, scan.data() + next * row_bytes, row_bytes) != 0) {
      ++next;
    }
    if (next == points) return std::nullopt;
    indices.push_back(static_cast<std::uint32_t>(next));
  }
  return indices;
}

EncodedColumn encode_subset(fb::Field field, std::span<const std::uint32_t> scan_indices) {
  const std::uint32_t first = scan_indices.front();
  const std::uint32_t span = scan_indices.back() - first + 1;
  EncodedColumn column{field, fb::ColumnCodec::Subset,           0,
                       0,     first | std::uint64_t{span} << 32, Bytes((span + 7) / 8)};
  for (const std::uint32_t index : scan_indices) {
    column.bytes[(index - first) / 8] |= static_cast<std::byte>(1u << ((index - first) % 8));
  }
  return column;
}

}  // namespace zonepack::packer
