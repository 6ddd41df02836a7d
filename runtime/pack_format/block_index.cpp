// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/block_index.hpp"

#include <cstring>
#include <limits>

namespace zonepack {
namespace {

constexpr std::uint32_t kRowBits = 10;  // a record has at most a cube of 512 blocks
constexpr std::uint32_t kMostRows = kBlockSide * kBlockSide * kBlockSide;
constexpr std::uint32_t kMostRecords = 1u << (32 - kRowBits);

std::uint64_t hash_of(const BlockPosition& p) noexcept {
  std::uint64_t h = static_cast<std::uint32_t>(p.x) * 0x9E3779B97F4A7C15ULL;
  h = (h ^ h >> 29 ^ static_cast<std::uint32_t>(p.y)) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ h >> 32 ^ static_cast<std::uint32_t>(p.z)) * 0x94D049BB133111EBULL;
  return h ^ h >> 31;
}

}  // namespace

std::optional<VoxelLayer> voxel_layer_of(fb::Part part) noexcept {
  const auto number = static_cast<std::uint32_t>(part);
  constexpr auto kFirst = static_cast<std::uint32_t>(fb::Part::TsdfBlocks);
  if (number < kFirst || number >= kFirst + kVoxelLayers) return std::nullopt;
  return static_cast<VoxelLayer>(number - kFirst);
}

Result<BlockIndex> BlockIndex::make(std::span<const RecordView> records) {
  BlockIndex index;
  index.records_ = records.data();
  std::array<std::int32_t, 3> cube{};
  for (std::size_t i = 0; i < records.size(); ++i) {
    const RecordView& record = records[i];
    const std::optional<VoxelLayer> layer = voxel_layer_of(record.part());
    if (!layer) continue;
    if (record.first_row() == 0) {
      const ColumnView info = record.column(fb::Field::Info);
      if (!info || info.codec() != fb::ColumnCodec::Raw || info.bytes().size() != sizeof cube) {
        return {ErrorCode::kMismatch, record.signature()};
      }
      cube = read_once<std::array<std::int32_t, 3>>(info.bytes().data());
    }
    if (i >= kMostRecords) return {ErrorCode::kMismatch, record.signature()};
    if (const auto added = index.add(static_cast<std::uint32_t>(i), *layer, cube); !added) {
      return added.error();
    }
  }
  return index;
}

Result<void> BlockIndex::add(std::uint32_t record_index, VoxelLayer layer,
                             const std::array<std::int32_t, 3>& cube) {
  const RecordView& record = records_[record_index];
  const Error wrong{ErrorCode::kMismatch, record.signature()};
  const ColumnView places = record.column(fb::Field::Place);
  const ColumnView voxels = record.column(fb::Field::Voxels);
  if (!places || !record.column(fb::Field::SourceRow) || !voxels ||
      voxels.param() != planes_of(layer) || record.total_rows() > kMostRows) {
    return wrong;
  }
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max() / 8;
  for (const std::int32_t c : cube) {
    if (c < -kFar || c >= kFar) return wrong;
  }
  const auto side = static_cast<std::int32_t>(kBlockSide);
  for (std::uint32_t row = 0; row < record.rows(); ++row) {
    const std::uint32_t place = places.bits_at(row);
    if (place >= kMostRows) return wrong;
    const auto xyz = xyz_of_place(place);
    Block* const block = find_or_add({cube[0] * side + static_cast<std::int32_t>(xyz[0]),
                                      cube[1] * side + static_cast<std::int32_t>(xyz[1]),
                                      cube[2] * side + static_cast<std::int32_t>(xyz[2])});
    std::uint32_t& own = block->place[static_cast<std::size_t>(layer)];
    if (own != kNone) return wrong;
    own = record_index << kRowBits | row;
  }
  return {};
}

void BlockIndex::grow() {
  table_.assign(table_.empty() ? 64 : table_.size() * 2, kNone);
  const std::size_t mask = table_.size() - 1;
  for (std::uint32_t i = 0; i < blocks_.size(); ++i) {
    std::size_t at = static_cast<std::size_t>(hash_of(blocks_[i].position)) & mask;
    while (table_[at] != kNone) at = (at + 1) & mask;
    table_[at] = i;
  }
}

BlockIndex::Block* BlockIndex::find_or_add(const BlockPosition& position) {
  if (table_.size() < 2 * (blocks_.size() + 1)) grow();
  const std::size_t mask = table_.size() - 1;
  std::size_t at = static_cast<std::size_t>(hash_of(position)) & mask;
  for (; table_[at] != kNone; at = (at + 1) & mask) {
    if (blocks_[table_[at]].position == position) return &blocks_[table_[at]];
  }
  table_[at] = static_cast<std::uint32_t>(blocks_.size());
  Block& block = blocks_.emplace_back();
  block.position = position;
  block.place.fill(kNone);
  return &block;
}

const BlockIndex::Block* BlockIndex::find(const BlockPosition& position) const noexcept {
  if (table_.empty()) return nullptr;
  const std::size_t mask = table_.size() - 1;
  std::size_t at = static_cast<std::size_t>(hash_of(position)) & mask;
  for (; table_[at] != kNone; at = (at + 1) & mask) {
    if (blocks_[table_[at]].position == position) return &blocks_[table_[at]];
  }
  return nullptr;
}

ByteSpan BlockIndex::bytes_of(const Block& block, VoxelLayer layer) const noexcept {
  const std::uint32_t place = block.place[static_cast<std::size_t>(layer)];
  if (place == kNone) return {};
  const RecordView& record = records_[place >> kRowBits];
  return block_at(record.column(fb::Field::Voxels).bytes(), record.rows(),
                  place & ((1u << kRowBits) - 1));
}

std::uint32_t BlockIndex::source_row(const Block& block, VoxelLayer layer) const noexcept {
  const std::uint32_t place = block.place[static_cast<std::size_t>(layer)];
  if (place == kNone) return 0;
  return records_[place >> kRowBits]
      .column(fb::Field::SourceRow)
      .bits_at(place & ((1u << kRowBits) - 1));
}

}  // namespace zonepack
