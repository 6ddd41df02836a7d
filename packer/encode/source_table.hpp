// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "packer/encode/column_encoder.hpp"
#include "packer/record/record.hpp"
#include "runtime/pack_format/bulk_chunk_generated.h"

namespace zonepack::packer {

// A column before encoding: rows of equal length.
struct SourceColumn {
  fb::Field field{};
  std::uint32_t row_bytes = 0;
  bool values = false;  // 32-bit values, stored in their smallest form; else rows of bytes
  Bytes data;
  // Of encoded blocks of voxels, which differ in length: where each ends in `data`. Else empty.
  std::vector<std::uint32_t> ends{};
  std::uint32_t planes = 0;  // of such a block
};

// One table of one signature, to be stored in chunks whole or in pieces of rows.
struct SourceTable {
  std::uint32_t signature = 0;  // ordinal within the zone
  fb::Part part{};
  std::uint16_t ordinal = 0;
  std::uint32_t rows = 0;
  std::vector<EncodedColumn> attributes;  // Shape, Info
  std::vector<SourceColumn> columns;
  float cell_size = 0;                                     // cells of a grid; else 0
  std::optional<std::vector<std::uint32_t>> scan_indices;  // cells that are points of the scan

  // Rows [first, first + count) in their smallest form; with the attributes when first is 0.
  std::vector<EncodedColumn> encode(std::uint32_t first, std::uint32_t count,
                                    LatticeEncoder& lattice) const;

  // Of the rows from `first` on, the most that can take at most so many bytes; where rows differ in
  // length and are kept as they are, this is known without encoding them.
  std::uint32_t rows_within(std::uint32_t first, std::uint64_t bytes) const;
  bool of_blocks() const { return !columns.empty() && columns.back().planes != 0; }
};

// All tables of a signature. Moves the large members out of `record`.
std::vector<SourceTable> tables_of(SignatureRecord& record, std::uint32_t ordinal);

}  // namespace zonepack::packer
