// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack {

// The part that holds the blocks of a layer.
constexpr fb::Part part_of(VoxelLayer layer) noexcept {
  return static_cast<fb::Part>(static_cast<std::uint16_t>(fb::Part::TsdfBlocks) +
                               static_cast<std::uint16_t>(layer));
}
std::optional<VoxelLayer> voxel_layer_of(fb::Part part) noexcept;

// Where a block lies among others: its lower corner is index x block size, in the map frame.
struct BlockPosition {
  std::int32_t x = 0, y = 0, z = 0;
  bool operator==(const BlockPosition&) const = default;
};

// The blocks of a zone's records, found by their position.
//
// Ownership: refers to the records, which must stay where they are.
// Memory: 28 bytes a block and a table of 8 to 16; make() allocates, nothing else does.
// Real-time: find() takes a constant number of steps on average.
// Threads: immutable once made.
class BlockIndex {
 public:
  struct Block {
    BlockPosition position;
    std::array<std::uint32_t, kVoxelLayers> place;  // record and row; kNone: not in that layer
  };
  static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

  // From all records of a zone, sorted by signature, part, and first row. kMismatch (detail: the
  // ordinal): a block is there twice in a layer, lies beyond 32 bits, or its table lacks a column.
  static Result<BlockIndex> make(std::span<const RecordView> records);

  std::uint32_t size() const noexcept { return static_cast<std::uint32_t>(blocks_.size()); }
  // In order of signature, then first layer, then place along the cube's Z curve.
  std::span<const Block> all() const noexcept { return blocks_; }
  const Block* find(const BlockPosition& position) const noexcept;

  // The stored bytes of a block in one layer; empty when it has none.
  ByteSpan bytes_of(const Block& block, VoxelLayer layer) const noexcept;
  // Its row in the source's table.
  std::uint32_t source_row(const Block& block, VoxelLayer layer) const noexcept;

 private:
  Result<void> add(std::uint32_t record, VoxelLayer layer, const std::array<std::int32_t, 3>& cube);
  Block* find_or_add(const BlockPosition& position);
  void grow();

  const RecordView* records_ = nullptr;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> table_;  // by hash: index into blocks_, or kNone; a power of two
};

}  // namespace zonepack
