// SPDX-License-Identifier: Apache-2.0
#include "tests/support/signature_recipe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <span>

#include "packer/record/block_layers.hpp"
#include "packer/sources/rtabmap/rtabmap_blobs.hpp"
#include "tests/support/blob_writer.hpp"

namespace zonepack::test_support {
namespace {

using packer::Features;
using packer::Grid;
using packer::Link;
using packer::Matrix;
using packer::Scan;
using packer::SignatureRecord;
using packer::Transform;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Numbers from the engine's raw bits only, which the standard fixes.
class Numbers {
 public:
  explicit Numbers(std::int32_t seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  std::int32_t below(std::int32_t limit) {
    return static_cast<std::int32_t>(engine_() % static_cast<std::uint64_t>(limit));
  }
  // A multiple of 1/256 in [low, high).
  float between(int low, int high) {
    return static_cast<float>(low) + static_cast<float>(below((high - low) * 256)) / 256.0f;
  }
  std::vector<float> floats(std::size_t count, int low, int high) {
    std::vector<float> values(count);
    for (float& value : values) value = between(low, high);
    return values;
  }

 private:
  std::mt19937_64 engine_;
};

Features make_features(const SignatureRecipe& recipe, Numbers& numbers) {
  Features f;
  f.count = recipe.features;
  f.descriptor_type = f.count == 0 ? Features::DescriptorType::kNone : recipe.descriptor;
  if (f.descriptor_type != Features::DescriptorType::kNone)
    f.descriptor_dim = recipe.descriptor_dim;
  for (std::size_t i = 0; i < f.count; ++i) {
    f.word_id.push_back(recipe.words_outside && i % 5 == 4 ? -numbers.below(3)
                                                           : 1 + numbers.below(10000));
    f.x.push_back(numbers.between(0, 640));
    f.y.push_back(numbers.between(0, 480));
    f.size.push_back(static_cast<float>(7 + numbers.below(60)));
    f.angle.push_back(numbers.between(0, 360));
    f.response.push_back(numbers.between(0, 1));
    f.octave.push_back(numbers.below(8) + (i % 2 == 0 ? 0 : 1 << 20));
    const bool none = recipe.partial_points && i % 3 == 2;
    f.point_x.push_back(none ? kNan : numbers.between(0, 10));
    f.point_y.push_back(none ? kNan : numbers.between(-5, 5));
    f.point_z.push_back(none || (recipe.partial_points && i % 7 == 6) ? kNan
                                                                      : numbers.between(0, 3));
    for (std::uint32_t d = 0; d < f.descriptor_dim; ++d) {
      if (f.descriptor_type == Features::DescriptorType::kU8) {
        f.descriptors.push_back(static_cast<std::byte>(numbers.below(256)));
      } else {
        const float value = numbers.between(-2, 2);
        const auto bytes = std::as_bytes(std::span(&value, 1));
        f.descriptors.insert(f.descriptors.end(), bytes.begin(), bytes.end());
      }
    }
  }
  return f;
}

Scan make_scan(const SignatureRecipe& recipe, Numbers& numbers) {
  Scan scan;
  scan.format = recipe.scan_format;
  scan.range_min = 0.125f;
  scan.range_max = 12;
  scan.angle_min = -2.5f;
  scan.angle_max = 2.5f;
  scan.angle_increment = 0.0078125f;
  scan.max_points = static_cast<float>(recipe.scan_points);
  scan.local_transform = level_pose(0.25f, 0, 0.5f, recipe.scan_format % 4);
  const auto channels = static_cast<std::int32_t>(packer::scan_channels(recipe.scan_format));
  // Clouds with several rings keep them as rows.
  const std::int32_t rows = channels > 3 ? 4 : 1;
  const std::int32_t cols = recipe.scan_points / rows;
  scan.data = float_matrix(rows, cols, channels,
                           numbers.floats(static_cast<std::size_t>(rows * cols * channels), -8, 8));
  return scan;
}

// A fan of cells on a lattice as RTAB-Map makes it: float32(i) * cell, then + origin, row by row.
Matrix lattice_cells(std::int32_t size, float cell, float origin) {
  std::vector<float> values;
  for (std::int32_t row = 0; row < size; ++row) {
    for (std::int32_t col = row / 2; col < size - row / 2; ++col) {
      for (const std::int32_t i : {col, row}) {
        const float scaled = static_cast<float>(i) * cell;
        values.push_back(scaled + origin);
      }
    }
  }
  return float_matrix(1, static_cast<std::int32_t>(values.size() / 2), 2, values);
}

Grid make_grid(const SignatureRecipe& recipe, const std::optional<Scan>& scan, Numbers& numbers) {
  Grid grid;
  grid.cell_size = 0.05f;
  grid.view_point = {0.25f, 0, 0.5f};
  if (recipe.grid_channels == 2) {
    grid.empty = lattice_cells(24, grid.cell_size, -0.6f);
    if (scan && scan->data.type == float_type(2)) {
      // Obstacles are points of the scan.
      const std::size_t bytes = scan->data.data.size() / 2 / 8 * 8;
      grid.obstacle = Matrix{1, static_cast<std::int32_t>(bytes / 8), float_type(2),
                             Bytes(scan->data.data.begin(),
                                   scan->data.data.begin() + static_cast<std::ptrdiff_t>(bytes))};
    }
    return grid;
  }
  const std::int32_t channels = recipe.grid_channels;
  const auto cells = [&](std::int32_t count) {
    return float_matrix(1, count, channels,
                        numbers.floats(static_cast<std::size_t>(count * channels), -4, 4));
  };
  grid.ground = cells(30);
  grid.obstacle = cells(20);
  grid.empty = cells(40);
  return grid;
}

Bytes make_depth(SignatureRecipe::Depth kind, std::int32_t id, Numbers& numbers) {
  constexpr std::uint32_t kWidth = 16, kHeight = 12;
  std::vector<std::uint16_t> depth_mm(kWidth * kHeight);
  std::vector<float> depth_m(depth_mm.size());
  for (std::size_t i = 0; i < depth_mm.size(); ++i) {
    depth_mm[i] = static_cast<std::uint16_t>(i % 9 < 3 ? 0 : 500 + numbers.below(4000));
    depth_m[i] = static_cast<float>(depth_mm[i]) / 1000.0f;
  }
  switch (kind) {
    case SignatureRecipe::Depth::kNone:
      return {};
    case SignatureRecipe::Depth::kPng16:
      return depth_png_16(kWidth, kHeight, depth_mm);
    case SignatureRecipe::Depth::kPngFloat:
      return depth_png_float(kWidth, kHeight, depth_m);
    case SignatureRecipe::Depth::kRvl:
      return rvl(kWidth, kHeight, depth_mm);
    case SignatureRecipe::Depth::kRightJpeg:
      return jpeg("right " + std::to_string(id));
  }
  return {};
}

Bytes make_image(const SignatureRecipe& recipe, Numbers& numbers) {
  if (recipe.image == SignatureRecipe::Image::kNone) return {};
  if (recipe.image == SignatureRecipe::Image::kJpeg) {
    return jpeg("left " + std::to_string(recipe.id));
  }
  Bytes pixels;
  for (int i = 0; i < 8 * 6 * 3; ++i) pixels.push_back(static_cast<std::byte>(numbers.below(256)));
  return png(8, 6, 8, 2, pixels);
}

Bytes make_calibration(SignatureRecipe::Camera kind) {
  const Transform left = level_pose(0.25f, 0.125f, 0.5f, 1), right = level_pose(0.25f, -0.125f, 1);
  Bytes bytes;
  if (kind == SignatureRecipe::Camera::kStereo) return stereo_camera(640, 480, 385, 0.125, left);
  if (kind == SignatureRecipe::Camera::kMono || kind == SignatureRecipe::Camera::kTwoMono) {
    bytes = mono_camera(640, 480, 385, left);
  }
  if (kind == SignatureRecipe::Camera::kTwoMono) {
    const Bytes second = mono_camera(320, 240, 190, right);
    bytes.insert(bytes.end(), second.begin(), second.end());
  }
  return bytes;
}

// Blocks at places 3 and 72 of a cube: one not observed, one of a wall in noise; colours, occupancy
// of three values, and an ESDF of small squares.
packer::BlockCube make_blocks(std::int32_t id) {
  Numbers numbers(id + 1000);
  packer::BlockCube cube;
  cube.index = {id, -1, 0};
  packer::BlockLayers layers;
  layers.block_size_m = 0.5;
  for (std::size_t i = 0; i < layers.layers.size(); ++i) {
    const std::string name = packer::kBlockLayerNames[i];
    layers.layers[i] = {"CREATE TABLE " + name +
                            "_metadata (param_name TEXT, value_string TEXT, "
                            "value_int INTEGER, value_float REAL)",
                        "CREATE TABLE " + name + "_data (index_x, index_y, index_z, data BLOB)",
                        {{std::string("block_size"), {}, {}, 0.5}}};
  }
  cube.layers_info = packer::write_block_layers(layers);
  const auto put = [](packer::Bytes& out, auto value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out.insert(out.end(), bytes.begin(), bytes.end());
  };
  std::vector<float> noise = numbers.floats(512, -1, 1);
  for (float& value : noise) value *= 0.2f;
  cube.layers[0] = {{3, 72}, {11, 7}, packer::Bytes(4096)};
  for (auto* layer : {&cube.layers[1], &cube.layers[2], &cube.layers[3]}) *layer = {{72}, {5}, {}};
  for (std::uint32_t i = 0; i < 512; ++i) {
    const bool near = i % 64 < 24;
    put(cube.layers[0].voxels, near ? noise[i] : i < 256 ? 0.0f : 0.2f);
    put(cube.layers[0].voxels, i < 256 && !near ? 0.0f : 5.0f);
    put(cube.layers[1].voxels, near ? 0xFF604020u + i % 7 : 0u);
    put(cube.layers[1].voxels, near ? 1.0f : 0.0f);
    put(cube.layers[2].voxels, near ? 0.847f : i < 256 ? 0.0f : -3.5f);
    put(cube.layers[3].voxels, static_cast<float>((i / 64) * (i / 64)));
    for (const std::int32_t way : {-static_cast<std::int32_t>(i / 64), 0, 0}) {
      put(cube.layers[3].voxels, way);
    }
    put(cube.layers[3].voxels, i < 256 ? 0x100u : 0x10100u);
  }
  return cube;
}

}  // namespace

Transform level_pose(float x, float y, float z, int quarter_turns) {
  constexpr std::array<float, 4> kCos = {1, 0, -1, 0}, kSin = {0, 1, 0, -1};
  const auto turn = static_cast<std::size_t>(quarter_turns) & 3;
  const float c = kCos[turn], s = kSin[turn];
  return {c, -s, 0, x, s, c, 0, y, 0, 0, 1, z};
}

Link make_link(std::int32_t to, std::int32_t type, const Transform& transform) {
  Link link{.to = to,
            .type = type,
            .transform = transform,
            .information = std::vector<double>(36, 0.0),
            .user_data = {}};
  for (std::size_t i = 0; i < 6; ++i) link.information[i * 7] = i < 3 ? 128 : 1024;
  link.information[1] = link.information[6] = 0.25;
  return link;
}

SignatureRecord make_signature(const SignatureRecipe& recipe) {
  Numbers numbers(recipe.id);
  SignatureRecord r;
  r.id = recipe.id;
  r.map_id = recipe.map_id;
  r.weight = recipe.id % 3;
  r.stamp = 1718021600.0 + recipe.id * 0.5;
  r.label = recipe.label;
  r.pose = level_pose(recipe.x, recipe.y, 0, recipe.id % 4);
  r.odometry_pose = level_pose(recipe.x + 0.125f, recipe.y - 0.25f, 0, recipe.id % 4);
  r.calibration = make_calibration(recipe.camera);
  r.features = make_features(recipe, numbers);
  if (recipe.scan_format != 0) r.scan = make_scan(recipe, numbers);
  if (recipe.grid_channels != 0) r.grid = make_grid(recipe, r.scan, numbers);
  r.image = make_image(recipe, numbers);
  r.depth = make_depth(recipe.depth, recipe.id, numbers);
  if (recipe.user_data) {
    r.user_data = float_matrix(2, 3, 1, numbers.floats(6, -9, 9));
  }
  if (recipe.blocks) r.blocks = make_blocks(recipe.id);
  if (recipe.global_descriptor) {
    r.global_descriptors.push_back(
        {1, std::nullopt, float_matrix(1, 64, 1, numbers.floats(64, -1, 1))});
    r.global_descriptors.push_back({2, Matrix{1, 3, 0, Bytes(3, std::byte{7})},
                                    float_matrix(1, 8, 1, numbers.floats(8, -1, 1))});
  }
  if (recipe.sensors) {
    r.ground_truth_pose = r.pose;
    r.velocity = bytes_of(std::vector<float>{0.5f, 0, 0, 0, 0, 0.25f});
    r.gps = bytes_of(std::vector<double>{r.stamp, 9.5, 48.25, 510, 2.5, 90});
    r.env_sensors = bytes_of(std::vector<double>{1, -60, r.stamp, 3, 21.5, r.stamp});
    if (!r.depth.empty()) {
      const auto confidence = Matrix{12, 16, 0, Bytes(16 * 12, std::byte{100})};
      r.depth_confidence = zip(confidence);
    }
  }
  for (const std::int32_t to : recipe.neighbours) {
    r.links.push_back(make_link(to, 0, level_pose(1, 0)));
  }
  return r;
}

}  // namespace zonepack::test_support
