// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/nvblox/nvblox_source.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace zonepack::packer {
namespace {

Transform pose_of(const NvbloxCube& cube) {
  const auto b = [&cube](std::size_t i) { return static_cast<float>(cube.base[i]); };
  return {1, 0, 0, b(0), 0, 1, 0, b(1), 0, 0, 1, b(2)};
}

std::shared_ptr<const MapOutline> outline_of(const NvbloxMap& map) {
  auto outline = std::make_shared<MapOutline>();
  outline->kind = "nvblox";
  outline->schema_version = "sqlite";
  outline->is_blocks = true;
  outline->has_optimised_poses = true;
  outline->warnings = map.warnings;
  outline->notes = map.notes;
  outline->block_bytes = map.source_bytes;
  for (const NvbloxCube& cube : map.cubes) {
    NodeOutline& node = outline->nodes.emplace_back();
    node.id = cube.id;
    node.pose = pose_of(cube);
    if (!cube.damage) continue;
    node.damaged = true;
    outline->damages.push_back(*cube.damage);
  }
  return outline;
}

}  // namespace

NvbloxSource::NvbloxSource(const SourceOptions& options)
    : path_(options.path),
      file_(options.path),
      map_(std::make_shared<const NvbloxMap>(read_nvblox_map(file_, options))),
      outline_(outline_of(*map_)) {
  file_.require_unchanged();
}

NvbloxSource::NvbloxSource(const std::filesystem::path& path, std::shared_ptr<const NvbloxMap> map,
                           std::shared_ptr<const MapOutline> outline)
    : path_(path), file_(path), map_(std::move(map)), outline_(std::move(outline)) {}

std::unique_ptr<MapSource> NvbloxSource::reopen() const {
  std::unique_ptr<MapSource> again(new NvbloxSource(path_, map_, outline_));
  require_unchanged();
  return again;
}

void NvbloxSource::read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) {
  const auto cube = std::ranges::lower_bound(map_->cubes, id, {}, &NvbloxCube::id);
  if (cube == map_->cubes.end() || cube->id != id) {
    throw std::runtime_error(file_.name() + ": has no cube " + std::to_string(id));
  }
  if (cube->damage) throw DamagedSignature(file_.name(), *cube->damage);
  into = SignatureRecord();
  into.id = id;
  into.pose = pose_of(*cube);
  if (!wanted.blocks) return;
  BlockCube& blocks = into.blocks.emplace();
  blocks.layers_info = map_->layers_info;
  const auto own = std::span(map_->blocks).subspan(cube->first, cube->count);
  blocks.index = {own.front().x >> 3, own.front().y >> 3, own.front().z >> 3};
  for (const NvbloxBlock& block : own) read_block(*cube, block, blocks.layers[block.layer]);
}

void NvbloxSource::read_block(const NvbloxCube& cube, const NvbloxBlock& block, BlockLayer& into) {
  const std::string table = std::string(kBlockLayerNames[block.layer]) + "_data";
  const auto damaged = [&](const std::string& problem) {
    throw DamagedSignature(file_.name(), {cube.id, table, block_text(block) + ": " + problem});
  };
  auto& query = data_[block.layer];
  if (!query) {
    query.emplace(file_, "SELECT data FROM " + table + " WHERE rowid=?1", kLargestValueBytes);
  }
  try {
    query->restart(std::int64_t{block.row});
    if (!query->step()) damaged("its row is gone");
  } catch (const SqliteCorrupt& error) {
    damaged(error.problem());
  }
  if (query->type(0) != SQLITE_BLOB) damaged("expected a blob");
  const auto bytes = query->blob(0);
  if (bytes.size() != block_bytes_of(block.layer)) {
    damaged(length_problem(block.layer, bytes.size()));
  }
  into.place.push_back(static_cast<std::uint16_t>(place_of(block)));
  into.row.push_back(block.row);
  into.voxels.insert(into.voxels.end(), bytes.begin(), bytes.end());
}

}  // namespace zonepack::packer
