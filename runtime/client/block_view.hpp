// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/pack_format/block_index.hpp"
#include "runtime/pack_format/zone_view.hpp"

// Blocks of voxels of a loaded zone, as nvblox keeps them. Valid as long as the ZoneView below.
//
// Units: metres; a block's lower corner is its index x block_size_m(), in the map frame. Voxels are
// in the order [x][y][z], z fastest: voxel (x, y, z) of a block, each 0 to 7, is number
// x * 64 + y * 8 + z.
// Threads: immutable.
// Real-time: nothing allocates.
namespace zonepack {

struct TsdfVoxel {
  float distance_m = 0, weight = 0;  // weight 0: not observed
};
struct ColorVoxel {
  std::uint8_t r = 0, g = 0, b = 0, a = 0;
  float weight = 0;
};
struct OccupancyVoxel {
  float log_odds = 0;
};
struct EsdfVoxel {
  float squared_distance = 0;            // of voxels
  std::array<std::int32_t, 3> parent{};  // towards the nearest site, voxels
  std::uint8_t inside = 0, observed = 0, site = 0, padding = 0;
};
static_assert(sizeof(TsdfVoxel) == 8 && sizeof(ColorVoxel) == 8 && sizeof(OccupancyVoxel) == 4 &&
              sizeof(EsdfVoxel) == 20);

template <typename Voxel>
using VoxelsOfBlock = std::span<Voxel, kVoxelsOfBlock>;

// One block. Decoding one layer of it takes about ten microseconds; a single voxel, one or two.
class BlockView {
 public:
  BlockView(const BlockIndex& index, const BlockIndex::Block& block) noexcept
      : index_(&index), block_(&block) {}

  const BlockPosition& position() const noexcept { return block_->position; }
  bool has(VoxelLayer layer) const noexcept {
    return block_->place[static_cast<std::size_t>(layer)] != BlockIndex::kNone;
  }

  // Each copies all voxels, bit for bit; false when the block has no such layer (or the zone was
  // unloaded meanwhile, which read() reports).
  bool copy_tsdf(VoxelsOfBlock<TsdfVoxel> out) const noexcept {
    return copy(VoxelLayer::kTsdf, std::as_writable_bytes(out));
  }
  bool copy_color(VoxelsOfBlock<ColorVoxel> out) const noexcept {
    return copy(VoxelLayer::kColor, std::as_writable_bytes(out));
  }
  bool copy_occupancy(VoxelsOfBlock<OccupancyVoxel> out) const noexcept {
    return copy(VoxelLayer::kOccupancy, std::as_writable_bytes(out));
  }
  bool copy_esdf(VoxelsOfBlock<EsdfVoxel> out) const noexcept {
    return copy(VoxelLayer::kEsdf, std::as_writable_bytes(out));
  }
  // The same as nvblox stores them; `out` holds bytes_of_block(planes_of(layer)).
  bool copy(VoxelLayer layer, std::span<std::byte> out) const noexcept {
    return copy_block(index_->bytes_of(*block_, layer), planes_of(layer), out);
  }

  // One voxel, in place; x, y, z of 0 to 7.
  std::optional<TsdfVoxel> tsdf_at(std::uint32_t x, std::uint32_t y,
                                   std::uint32_t z) const noexcept {
    return voxel_at<TsdfVoxel>(VoxelLayer::kTsdf, x, y, z);
  }
  std::optional<OccupancyVoxel> occupancy_at(std::uint32_t x, std::uint32_t y,
                                             std::uint32_t z) const noexcept {
    return voxel_at<OccupancyVoxel>(VoxelLayer::kOccupancy, x, y, z);
  }
  std::optional<EsdfVoxel> esdf_at(std::uint32_t x, std::uint32_t y,
                                   std::uint32_t z) const noexcept {
    return voxel_at<EsdfVoxel>(VoxelLayer::kEsdf, x, y, z);
  }
  std::optional<ColorVoxel> color_at(std::uint32_t x, std::uint32_t y,
                                     std::uint32_t z) const noexcept {
    return voxel_at<ColorVoxel>(VoxelLayer::kColor, x, y, z);
  }

 private:
  template <typename Voxel>
  std::optional<Voxel> voxel_at(VoxelLayer layer, std::uint32_t x, std::uint32_t y,
                                std::uint32_t z) const noexcept {
    VoxelPlanes planes;
    if (!parse_block(index_->bytes_of(*block_, layer), planes_of(layer), planes)) {
      return std::nullopt;
    }
    std::array<std::uint32_t, sizeof(Voxel) / 4> words;
    for (std::size_t p = 0; p < words.size(); ++p) words[p] = planes[p].at(x * 64 + y * 8 + z);
    return std::bit_cast<Voxel>(words);
  }

  const BlockIndex* index_;
  const BlockIndex::Block* block_;
};

class BlocksView {
 public:
  explicit BlocksView(const ZoneView& zone) noexcept : zone_(&zone) {}

  std::uint32_t size() const noexcept { return zone_->blocks().size(); }
  // 0 when the zone holds no blocks.
  double block_size_m() const noexcept;

  // `index` is below size(). Blocks are in no order that means anything.
  BlockView operator[](std::uint32_t index) const noexcept {
    return {zone_->blocks(), zone_->blocks().all()[index]};
  }
  // The block that the zone has at an index, in a constant number of steps on average.
  std::optional<BlockView> find(std::int32_t x, std::int32_t y, std::int32_t z) const noexcept {
    const BlockIndex::Block* const block = zone_->blocks().find({x, y, z});
    if (block == nullptr) return std::nullopt;
    return BlockView(zone_->blocks(), *block);
  }
  // The block that a point of the map frame lies in.
  std::optional<BlockView> at(double x_m, double y_m, double z_m) const noexcept;

  // Calls fn(const BlockView&) for each.
  template <typename Fn>
  void for_each(Fn&& fn) const {
    for (const BlockIndex::Block& block : zone_->blocks().all()) {
      fn(BlockView(zone_->blocks(), block));
    }
  }

 private:
  const ZoneView* zone_;
};

}  // namespace zonepack
