// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/pack_format/block_index.hpp"
#include "runtime/pack_format/chunk_view.hpp"

namespace zonepack {

// A decoded and checked chunk in memory.
struct ChunkRef {
  fb::PayloadKind kind;
  ByteSpan bytes;
};

// A run of signatures of a zone, both ends included.
struct OrdinalRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0xFFFFFFFFu;
  bool contains(std::uint32_t ordinal) const noexcept {
    return first <= ordinal && ordinal <= last;
  }
};

// One table of a signature (its features, its scan …) across the records that hold its rows.
class TableView {
 public:
  explicit TableView(std::span<const RecordView> records) : records_(records) {}
  std::span<const RecordView> records() const noexcept { return records_; }
  fb::Part part() const noexcept { return records_.front().part(); }
  std::uint16_t ordinal() const noexcept { return records_.front().ordinal(); }
  std::uint32_t total_rows() const noexcept { return records_.front().total_rows(); }
  // Attributes are in the first record.
  ColumnView attribute(fb::Field field) const noexcept { return records_.front().column(field); }

 private:
  std::span<const RecordView> records_;
};

// The signatures of one zone as its decoded chunks hold them, read in place: no value is copied.
// Ordinals count a zone's signatures from 0 in the order of their ids.
//
// Ownership: refers to the chunks' bytes, which must outlive the view.
// Memory: make() allocates; nothing else does.
// Threads: immutable once made.
class ZoneView {
 public:
  // Refuses tables whose records leave out, repeat or contradict rows (kMismatch; detail: the
  // ordinal), signatures without a core record, ids out of order, and blocks that are there twice.
  // With a range, the view holds only its signatures, and the chunks may lack parts of others.
  static Result<ZoneView> make(std::span<const ChunkRef> chunks, OrdinalRange range = {});

  // The same from checked core chunks and the records of all other chunks.
  static Result<ZoneView> make(std::span<const fb::CoreChunk* const> cores,
                               std::vector<RecordView> records, OrdinalRange range = {});

  std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(core_.size()); }

  // An entry of a core chunk; its indices refer to that chunk's lists.
  struct More {
    const fb::CoreChunk* chunk;
    const fb::Signature* signature;
  };
  struct Core {
    const fb::CoreChunk* chunk;
    const fb::Signature* signature;
    std::vector<More> more_links;  // entries that continue it
  };
  const Core& core(std::uint32_t ordinal) const noexcept { return core_[ordinal - first_]; }

  // All tables of a signature, by part, then ordinal.
  std::span<const TableView> tables(std::uint32_t ordinal) const noexcept {
    const std::size_t* const table = &first_table_[ordinal - first_];
    return {tables_.data() + table[0], table[1] - table[0]};
  }
  const TableView* table(std::uint32_t ordinal, fb::Part part) const noexcept;

  // The zone's blocks of voxels by their index; empty for maps without any.
  const BlockIndex& blocks() const noexcept { return blocks_; }

 private:
  std::uint32_t first_ = 0;  // ordinal of core_[0]
  std::vector<Core> core_;
  std::vector<RecordView> records_;  // by signature, part, ordinal, first row
  std::vector<TableView> tables_;
  std::vector<std::size_t> first_table_;  // size() + 1
  BlockIndex blocks_;
};

}  // namespace zonepack
