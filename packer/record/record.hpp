// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// One map node as a source database holds it, bit for bit, before anything is encoded.
// Frames: map = the optimised world frame; odom = the mapping robot's odometry frame; base = the
// robot (x forward, y left, z up). Units: metres, radians, seconds since the epoch of the source.
namespace zonepack::packer {

using Bytes = std::vector<std::byte>;

// The largest matrix accepted from a source: a scan of ten million points.
inline constexpr std::uint64_t kLargestMatrixBytes = std::uint64_t{256} << 20;

// Rigid transform, row-major 3x4: rotation and translation of the child in the parent.
using Transform = std::array<float, 12>;

// An unzipped matrix blob: rows x cols elements of an OpenCV type (depth = type & 7, channels =
// (type >> 3) + 1), row-major, no padding. data.size() == rows * cols * element size, always.
struct Matrix {
  std::int32_t rows = 0;
  std::int32_t cols = 0;
  std::int32_t type = 0;
  Bytes data;
};

// Keypoints of one signature, one entry per feature, in the database's row order.
struct Features {
  std::size_t count = 0;
  std::vector<float> x, y;  // pixels
  std::vector<float> size, angle, response;
  std::vector<std::int32_t> octave;
  std::vector<std::int32_t> word_id;  // <= 0: not in the dictionary
  // T_base, metres. NaN where the database holds NULL, coordinate by coordinate; SQLite itself
  // cannot store a NaN.
  std::vector<float> point_x, point_y, point_z;
  enum class DescriptorType : std::uint8_t { kNone, kU8, kF32 };
  DescriptorType descriptor_type = DescriptorType::kNone;
  std::uint32_t descriptor_dim = 0;  // elements per descriptor
  Bytes descriptors;                 // count * dim elements, row-major
};

struct GlobalDescriptor {
  std::int32_t type = 0;
  std::optional<Matrix> info;
  Matrix data;
};

struct Scan {
  std::int32_t format = 0;  // 1..12 (FORMATS: scan formats); 0 when the database does not say
  float range_min = 0, range_max = 0, angle_min = 0, angle_max = 0, angle_increment = 0;
  float max_points = 0;         // as stored
  Transform local_transform{};  // T_base_scan; all zero: the database holds none
  Matrix data;
};

struct Grid {
  float cell_size = 0;
  std::array<float, 3> view_point{};
  // float32 cells in the base frame; nullopt when NULL. Where all three are, there is no grid.
  std::optional<Matrix> ground, obstacle, empty;
};

// The blocks of one layer in a cube: 8 x 8 x 8 voxels each, bit for bit as nvblox stores them.
struct BlockLayer {
  std::vector<std::uint16_t> place;  // in the cube, ascending (place_in_cube of the pack format)
  std::vector<std::uint32_t> row;    // in the source's table
  Bytes voxels;                      // of one block after the other
};

// Blocks of voxels that lie in a cube of 8 x 8 x 8 blocks, or in one zone's part of it.
struct BlockCube {
  std::array<std::int32_t, 3> index{};  // the cube's lower corner is index * 8 * block size
  Bytes layers_info;  // block size, tables and metadata of the source (FORMAT.md: BlockLayers)
  std::array<BlockLayer, 4> layers;  // TSDF, colour, occupancy, ESDF
};

// RTAB-Map's numbers of links, of those that others have too.
inline constexpr std::int32_t kNeighbourLink = 0, kGlobalClosureLink = 1;

struct Link {
  std::int32_t to = 0;    // negative: a landmark
  std::int32_t type = 0;  // the database's integer
  std::optional<Transform> transform;
  std::vector<double> information;  // 36, row-major 6x6; empty where the schema or the row has none
  std::optional<Matrix> user_data;
};

// Which parts of a signature are wanted, and which a pack holds. The core (ids, poses, links,
// calibration) is always carried.
struct PayloadSet {
  bool features = true, scan = true, grid = true, image = true, depth = true, userdata = true,
       blocks = true;
};

struct SignatureRecord {
  std::int32_t id = 0;
  std::int32_t map_id = 0;  // layer
  std::int32_t weight = 0;  // -1: intermediate
  double stamp = 0;
  std::string label;                           // empty when NULL
  std::optional<Transform> pose;               // T_map_base, optimised; nullopt: not in the graph
  std::optional<Transform> odometry_pose;      // T_odom_base
  std::optional<Transform> ground_truth_pose;  // T_world_base
  Bytes velocity, gps,
      env_sensors;    // as stored (float32 x 6; float64 x 6; float64 x 3n); empty when NULL
  Bytes calibration;  // as stored; empty when NULL
  Features features;
  std::vector<GlobalDescriptor> global_descriptors;
  std::optional<Scan> scan;
  std::optional<Grid> grid;
  Bytes image, depth, depth_confidence;  // as stored; empty when NULL
  std::optional<Matrix> user_data;
  std::optional<BlockCube> blocks;
  std::vector<Link> links;  // rows with from_id = id, sorted by (type, to)
};

}  // namespace zonepack::packer
