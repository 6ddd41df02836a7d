// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "packer/record/record.hpp"
#include "runtime/pack_format/bulk_chunk_generated.h"

namespace zonepack::packer {

// One column in its stored form, before it has a place in a chunk.
struct EncodedColumn {
  fb::Field field{};
  fb::ColumnCodec codec{};
  std::uint8_t bits = 0;
  std::uint32_t param = 0;
  std::uint64_t base = 0;
  Bytes bytes;
};

// Encodes by the smallest of Constant, Packed, Scaled, Blocks and Raw that restores all 32 bits of
// every value.
EncodedColumn encode_values(fb::Field field, std::span<const std::uint32_t> values);

EncodedColumn encode_constant(fb::Field field, std::uint64_t value);
EncodedColumn encode_raw(fb::Field field, std::span<const std::byte> bytes,
                         std::uint32_t row_bytes);

// Finds the origin of grids whose cells are float(index) * cell + origin, and remembers it for the
// next grid, since most grids of a database share one.
//
// Threads: one object per thread.
class LatticeEncoder {
 public:
  // Encodes cells, (x, y) float32 pairs. Nothing when they are not cells of such a grid in
  // row-major order, or when the bitmap would not be smaller.
  std::optional<EncodedColumn> encode(std::span<const std::byte> cells, float cell_size);

 private:
  std::optional<float> origin_x_;
  std::optional<float> origin_y_;
};

// The ascending indices of the rows among those of a scan; nothing when a row is missing or out of
// order.
std::optional<std::vector<std::uint32_t>> subset_of(std::span<const std::byte> rows,
                                                    std::span<const std::byte> scan,
                                                    std::size_t row_bytes);
EncodedColumn encode_subset(fb::Field field, std::span<const std::uint32_t> scan_indices);

}  // namespace zonepack::packer
