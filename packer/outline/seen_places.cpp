// SPDX-License-Identifier: Apache-2.0
#include "packer/outline/seen_places.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>

#include "packer/outline/map_image.hpp"
#include "packer/record/block_layers.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

constexpr double kFarthestPlace_m = 1e7;
constexpr double kLeastCell_m = 0.05;
constexpr float kSurfaceVoxels = 0.75F;
constexpr std::int32_t kFlatFormats = 4;  // RTAB-Map's 1 to 4 are of scans in a plane
constexpr std::int32_t kFloat32 = 5;      // OpenCV's depth

bool has_heights(const Scan& scan) {
  return scan.format > kFlatFormats && (scan.data.type & 7) == kFloat32 &&
         (scan.data.type >> 3) >= 2;
}

float float_at(std::span<const std::byte> bytes, std::size_t at) {
  float value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// T * p, in float64: a tile of a map that lies far from its origin has float32 parts that add up.
std::array<double, 3> placed(const Transform& T, const std::array<double, 3>& p) {
  std::array<double, 3> out{};
  for (std::size_t row = 0; row < 3; ++row) {
    const float* const r = &T[row * 4];
    out[row] = r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3];
  }
  return out;
}

void for_each_point(const Scan& scan, const Transform& T_map_base, const SeenPlace& place) {
  const bool mounted = scan.local_transform != Transform{};
  const std::size_t stride = (static_cast<std::size_t>(scan.data.type >> 3) + 1) * sizeof(float);
  const std::span<const std::byte> bytes = scan.data.data;
  for (std::size_t at = 0; at + stride <= bytes.size(); at += stride) {
    std::array<double, 3> p = {float_at(bytes, at), float_at(bytes, at + 4),
                               float_at(bytes, at + 8)};
    if (mounted) p = placed(scan.local_transform, p);
    p = placed(T_map_base, p);
    const auto near = [](double v) { return std::abs(v) < kFarthestPlace_m; };
    if (near(p[0]) && near(p[1]) && near(p[2])) place(p[0], p[1], p[2], Seen::kSurface);
  }
}

// What a voxel of a layer says; `bytes` begin with it.
std::optional<Seen> seen_in(VoxelLayer layer, std::span<const std::byte> bytes, float voxel_m) {
  const float value = float_at(bytes, 0);
  switch (layer) {
    case VoxelLayer::kTsdf:
      if (!(float_at(bytes, 4) > 0) || std::isnan(value)) return std::nullopt;
      // Distances run along rays, so that a floor seen from the side has none that is near 0.
      return value <= kSurfaceVoxels * voxel_m ? Seen::kSurface : Seen::kFree;
    case VoxelLayer::kOccupancy:
      if (value == 0 || std::isnan(value)) return std::nullopt;
      return value > 0 ? Seen::kSurface : Seen::kFree;
    case VoxelLayer::kEsdf: {  // squared distance, parent (3 x int32), inside, observed, site
      if (bytes[17] == std::byte{0}) return std::nullopt;
      if (bytes[18] != std::byte{0}) return Seen::kSurface;
      return bytes[16] == std::byte{0} ? std::optional(Seen::kFree) : std::nullopt;
    }
    case VoxelLayer::kColor:
      break;
  }
  return std::nullopt;
}

double voxel_size_of(const BlockCube& cube) {
  const double block_m = read_block_layers(cube.layers_info).block_size_m;
  return decimal_of(static_cast<float>(block_m)) / kBlockSide;
}

void for_each_voxel(const BlockCube& cube, const SeenPlace& place) {
  const double voxel_m = voxel_size_of(cube);
  for (const VoxelLayer layer : {VoxelLayer::kTsdf, VoxelLayer::kOccupancy, VoxelLayer::kEsdf}) {
    const BlockLayer& own = cube.layers[static_cast<std::size_t>(layer)];
    if (own.place.empty()) continue;
    const std::size_t voxel_bytes = std::size_t{planes_of(layer)} * 4;
    std::span<const std::byte> bytes = own.voxels;
    for (const std::uint16_t number : own.place) {
      const auto block = xyz_of_place(number);
      std::array<double, 3> corner{};  // of the block, in voxels
      for (std::size_t axis = 0; axis < 3; ++axis) {
        corner[axis] = (static_cast<double>(cube.index[axis]) * 8 + block[axis]) * kBlockSide;
      }
      for (std::uint32_t i = 0; i < kVoxelsOfBlock && bytes.size() >= voxel_bytes; ++i) {
        const std::optional<Seen> seen = seen_in(layer, bytes, static_cast<float>(voxel_m));
        bytes = bytes.subspan(voxel_bytes);
        if (!seen) continue;
        const std::uint32_t x = i / 64, y = i / 8 % 8, z = i % 8;
        place((corner[0] + x + 0.5) * voxel_m, (corner[1] + y + 0.5) * voxel_m,
              (corner[2] + z + 0.5) * voxel_m, *seen);
      }
    }
    return;
  }
}

}  // namespace

void for_each_place(const SignatureRecord& record, const SeenPlace& place) {
  if (record.blocks) for_each_voxel(*record.blocks, place);
  if (record.scan && record.pose && has_heights(*record.scan)) {
    for_each_point(*record.scan, *record.pose, place);
  }
}

double cell_size_of(const SignatureRecord& record) {
  if (record.blocks) {
    const double voxel_m = voxel_size_of(*record.blocks);
    return voxel_m * std::ceil(kLeastCell_m / voxel_m - 1e-9);
  }
  return record.scan && has_heights(*record.scan) ? kLeastCell_m : 0;
}

}  // namespace zonepack::packer
