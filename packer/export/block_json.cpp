// SPDX-License-Identifier: Apache-2.0
#include "packer/export/block_json.hpp"

#include <array>
#include <map>
#include <optional>

#include "packer/record/block_layers.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

using Index = std::array<std::int64_t, 3>;
using Places = std::array<std::optional<std::size_t>, kVoxelLayers>;  // in each layer

// The blocks of the cube by index.
std::map<Index, Places> blocks_of(const BlockCube& cube) {
  std::map<Index, Places> blocks;
  for (std::size_t layer = 0; layer < kVoxelLayers; ++layer) {
    for (std::size_t i = 0; i < cube.layers[layer].place.size(); ++i) {
      const auto xyz = xyz_of_place(cube.layers[layer].place[i]);
      Index index{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        index[axis] = std::int64_t{cube.index[axis]} * kBlockSide + xyz[axis];
      }
      blocks[index][layer] = i;
    }
  }
  return blocks;
}

void write_line(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                const Index* index, const Places& places, double size) {
  json.begin_object();
  json.key("zone");
  json.text(zone);
  json.key("cube");
  json.integer(record.id);
  json.key("index");
  if (index == nullptr) {
    json.null();
  } else {
    json.begin_array();
    for (const std::int64_t i : *index) json.integer(i);
    json.end_array();
  }
  json.key("corner");
  if (index == nullptr) {
    json.null();
  } else {
    json.begin_array();
    for (const std::int64_t i : *index) json.number(static_cast<double>(i) * size);
    json.end_array();
  }
  json.key("block_size");
  index == nullptr ? json.null() : json.number(size);
  for (std::size_t layer = 0; layer < kVoxelLayers; ++layer) {
    json.key(kBlockLayerNames[layer]);
    if (!places[layer]) {
      json.null();
      continue;
    }
    const std::size_t bytes = bytes_of_block(kPlanesOfLayer[layer]);
    json.base64(
        std::span(record.blocks->layers[layer].voxels).subspan(*places[layer] * bytes, bytes));
  }
  json.end_object();
  json.end_line();
}

}  // namespace

void write_blocks(JsonLines& json, std::string_view zone, const SignatureRecord& record,
                  PayloadMask packed) {
  if ((packed & mask_of(fb::PayloadKind::Blocks)) == 0 || !record.blocks) {
    write_line(json, zone, record, nullptr, {}, 0);
    return;
  }
  const double size = read_block_layers(record.blocks->layers_info).block_size_m;
  for (const auto& [index, places] : blocks_of(*record.blocks)) {
    write_line(json, zone, record, &index, places, size);
  }
}

}  // namespace zonepack::packer
