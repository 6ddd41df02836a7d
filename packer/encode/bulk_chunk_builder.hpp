// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "packer/encode/source_table.hpp"
#include "runtime/pack_format/bulk_chunk_generated.h"

namespace zonepack::packer {

// Fills one bulk chunk with rows of tables, up to a given decoded size.
class BulkChunkBuilder {
 public:
  // Adds as many of the table's rows from `first` on as fit into a chunk of `capacity` bytes: all
  // of them, a piece worth storing, or none. `all_fit`: whether this reaches the table's end (true
  // for a table without rows).
  struct Added {
    std::uint32_t rows = 0;
    bool all_fit = false;
  };
  Added add(const SourceTable& table, std::uint32_t first, std::uint64_t capacity,
            LatticeEncoder& lattice);

  bool empty() const noexcept { return records_.empty(); }
  std::uint64_t size_bound() const noexcept { return size_with(0, 0, 0); }
  std::uint32_t first_signature() const noexcept { return first_signature_; }
  std::uint32_t last_signature() const noexcept { return last_signature_; }
  // Whether some rows are stored as indices of scan points.
  bool needs_scan() const noexcept { return needs_scan_; }

  // The chunk as a FlatBuffer; the builder is empty afterwards.
  Bytes finish();

 private:
  std::uint64_t size_with(std::size_t records, std::size_t columns,
                          std::size_t bytes) const noexcept;
  std::uint64_t size_with(const std::vector<EncodedColumn>& columns) const;
  void append(const SourceTable& table, std::uint32_t first, std::uint32_t rows,
              const std::vector<EncodedColumn>& columns);

  std::vector<fb::Record> records_;
  std::vector<fb::Column> columns_;
  Bytes bytes_;
  std::unordered_map<std::string, std::uint32_t> places_;  // of short columns, stored once each
  std::uint32_t first_signature_ = 0xFFFFFFFFu;
  std::uint32_t last_signature_ = 0;
  bool needs_scan_ = false;
};

}  // namespace zonepack::packer
