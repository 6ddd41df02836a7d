// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "platform/base/byte_span.hpp"

// Blocks of 8 x 8 x 8 voxels in the smallest form that restores every bit, read in place. A voxel
// is some fields of 32 bits; each field of all 512 voxels is a plane, stored by itself (FORMAT.md,
// "Planes").
namespace zonepack {

inline constexpr std::uint32_t kBlockSide = 8;
inline constexpr std::uint32_t kVoxelsOfBlock = 512;  // [x][y][z], z fastest

// What nvblox keeps in a block, in the order of their parts in a pack.
enum class VoxelLayer : std::uint8_t { kTsdf, kColor, kOccupancy, kEsdf };
inline constexpr std::uint32_t kVoxelLayers = 4;
inline constexpr std::array<std::uint32_t, kVoxelLayers> kPlanesOfLayer = {2, 2, 1, 5};
inline constexpr std::uint32_t kMostPlanes = 5;

constexpr std::uint32_t planes_of(VoxelLayer layer) noexcept {
  return kPlanesOfLayer[static_cast<std::size_t>(layer)];
}
// Bytes of a block as nvblox stores it.
constexpr std::uint32_t bytes_of_block(std::uint32_t planes) noexcept {
  return planes * 4 * kVoxelsOfBlock;
}

// How the values of a list lie on the voxels, first step: 512 voxels to `runs` values.
enum class VoxelSpread : std::uint8_t {
  kEach,      // a value for each voxel
  kColumns,   // one for each 8 voxels along z
  kRuns,      // a bit for each voxel: set, the next value begins
  kAsBefore,  // the runs of the plane before
};
// Second step: of these values, those that are in the list; the others are named constants.
enum class VoxelChoice : std::uint8_t {
  kNone,       // all are in the list
  kOneOfTwo,   // a bit each: set, the next of the list; clear, the constant
  kOneOfFour,  // two bits each, in two bitmaps: both set, the next of the list
  kAsBefore,   // the choice of the plane before, with other constants
};
enum class VoxelForm : std::uint8_t {
  kConstant,
  kRaw,
  kPacked,
  kScaled,
  kDictionary,
  kFloat,
  kBytes
};
enum class VoxelOrder : std::uint8_t { kUnsigned, kInt, kFloat };

inline constexpr std::uint32_t kMostHeads = 64;

// One field of a block's voxels. parse_block() makes it from bytes that may change later (another
// process's memory): values are wrong then, but no read leaves the block and kColumnPadding bytes
// behind it.
//
// Real-time: at() takes at most 24 popcounts, copy() one pass; no allocation.
// Threads: immutable.
class VoxelPlane {
 public:
  using Values = std::array<std::uint32_t, kVoxelsOfBlock>;

  std::uint32_t at(std::uint32_t voxel) const noexcept;
  void copy(Values& out) const noexcept;

  // Whether bits that mean nothing are zero and every index is one of its table; for verify.
  bool is_exact() const noexcept;

 private:
  friend class VoxelBlockReader;

  std::uint32_t value(std::uint32_t place) const noexcept;
  std::uint32_t width() const noexcept;  // bits of a value in the list
  void copy_list(Values& out) const noexcept;

  VoxelSpread spread_ = VoxelSpread::kEach;
  VoxelChoice choice_ = VoxelChoice::kNone;
  VoxelForm form_ = VoxelForm::kConstant;
  VoxelOrder order_ = VoxelOrder::kUnsigned;
  std::uint8_t bits_ = 0, fraction_ = 0, low_zeros_ = 0, head_bits_ = 0;
  std::uint32_t runs_ = kVoxelsOfBlock, listed_ = kVoxelsOfBlock;
  std::uint32_t base_ = 0, table_size_ = 0;
  std::array<std::uint32_t, 3> constants_{};
  std::array<std::uint16_t, kMostHeads> heads_{};
  std::array<std::uint8_t, 4> byte_base_{}, byte_bits_{};
  const std::byte* starts_ = nullptr;  // kRuns
  const std::byte* low_ = nullptr;     // the choice's bits
  const std::byte* high_ = nullptr;
  const std::byte* table_ = nullptr;  // kDictionary
  const std::byte* list_ = nullptr;
};

using VoxelPlanes = std::array<VoxelPlane, kMostPlanes>;

// The planes of a block; false unless they fill `bytes` exactly. Looks at headers and bitmaps only.
bool parse_block(ByteSpan bytes, std::uint32_t planes, VoxelPlanes& out) noexcept;

// Writes the block as nvblox stores it: bytes_of_block(planes) bytes. False when it is not sound.
bool copy_block(ByteSpan bytes, std::uint32_t planes, std::span<std::byte> out) noexcept;

// The bytes of block `row` in a Planes column (FORMAT.md); empty when the column does not have it.
ByteSpan block_at(ByteSpan column, std::uint32_t rows, std::uint32_t row) noexcept;

// Whether a Planes column holds `rows` sound blocks of so many planes, and nothing else.
bool planes_are_sound(ByteSpan column, std::uint32_t rows, std::uint32_t planes) noexcept;
// The same, and each plane is exact.
bool planes_are_exact(ByteSpan column, std::uint32_t rows, std::uint32_t planes) noexcept;

// The place of a block in its cube of 8 x 8 x 8 blocks, 9 bits: along a Z curve, so that neighbours
// in space are near each other.
std::uint32_t place_in_cube(std::uint32_t x, std::uint32_t y, std::uint32_t z) noexcept;
std::array<std::uint32_t, 3> xyz_of_place(std::uint32_t place) noexcept;

}  // namespace zonepack
