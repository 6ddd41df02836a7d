// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/nvblox/nvblox_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "packer/sources/nvblox/nvblox_tables.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

constexpr double kFarthest_m = 1e7;
constexpr std::uint32_t kNoZone = (1U << 29) - 1;

std::int32_t cube_of(std::int32_t index) noexcept { return index >> 3; }

auto key_of(const NvbloxBlock& b) {
  return std::tuple(cube_of(b.x), cube_of(b.y), cube_of(b.z), static_cast<std::uint32_t>(b.zone));
}

auto order_of(const NvbloxBlock& b) {
  return std::tuple_cat(key_of(b),
                        std::tuple(static_cast<std::uint32_t>(b.layer), place_of(b), b.row));
}

// As a signature's pose has it, so that a zone is asked for the same place.
double centre_of(std::int32_t index, double block_size_m) {
  return static_cast<double>(static_cast<float>((static_cast<double>(index) + 0.5) * block_size_m));
}

// An id that a cube keeps while the map grows: its place within some kilometres, and which of the
// zones it is in. 0: none.
std::int32_t wanted_id(const NvbloxBlock& b, std::uint32_t part) {
  const std::int64_t x = std::int64_t{cube_of(b.x)} + 512, y = std::int64_t{cube_of(b.y)} + 512,
                     z = std::int64_t{cube_of(b.z)} + 256;
  if (x < 0 || x >= 1024 || y < 0 || y >= 1024 || z < 0 || z >= 511 || part > 3) return 0;
  return static_cast<std::int32_t>(((x * 1024 + y) * 511 + z) * 4 + part + 1);
}

class Reading {
 public:
  Reading(const SqliteFile& file, const SourceOptions& options) : file_(file), options_(options) {
    NvbloxTables tables = read_nvblox_tables(file);
    map_.layers = std::move(tables.layers);
    map_.warnings = std::move(tables.warnings);
    map_.layers_info = write_block_layers(map_.layers);
  }

  NvbloxMap read() {
    for (std::size_t layer = 0; layer < kBlockLayerNames.size(); ++layer) {
      if (map_.layers.layers[layer]) read_layer(layer);
    }
    std::sort(map_.blocks.begin(), map_.blocks.end(),
              [](const auto& a, const auto& b) { return order_of(a) < order_of(b); });
    cut();
    describe();
    return std::move(map_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw SqliteError(file_.name() + ": " + what);
  }

  void read_layer(std::size_t layer) {
    const std::string table = std::string(kBlockLayerNames[layer]) + "_data";
    std::optional<SqliteQuery> row;
    try {
      row.emplace(file_, "SELECT rowid, index_x, index_y, index_z, length(data) FROM " + table,
                  kLargestValueBytes);
    } catch (const SqliteCorrupt&) {
      throw;
    } catch (const SqliteError& error) {
      fail(table + ": cannot be read by its rows, as a table of nvblox can (" + error.what() +
           "); save the map again with nvblox");
    }
    while (row->step()) {
      const std::int64_t number = row->integer(0);
      const std::string where = table + ": row " + std::to_string(number);
      if (number < 0 || number > std::numeric_limits<std::uint32_t>::max()) {
        fail(where + ": expected rows numbered from 0 to 4294967295; run: sqlite3 FILE VACUUM");
      }
      if (map_.blocks.size() == NvbloxMap::kMostBlocks) {
        fail("holds more than " + std::to_string(NvbloxMap::kMostBlocks) +
             " blocks in all layers; export the map in parts");
      }
      NvbloxBlock block{};
      block.x = index_of(*row, 1, where + ": index_x");
      block.y = index_of(*row, 2, where + ": index_y");
      block.z = index_of(*row, 3, where + ": index_z");
      block.layer = layer & 3U;
      block.wrong_length =
          row->is_null(4) || static_cast<std::uint64_t>(row->integer(4)) != block_bytes_of(layer);
      block.row = static_cast<std::uint32_t>(number);
      block.zone = zone_of(block) & kNoZone;
      map_.blocks.push_back(block);
      ++map_.block_count[layer];
      map_.source_bytes += block_bytes_of(layer);
    }
  }

  std::int32_t index_of(const SqliteQuery& row, int column, const std::string& where) const {
    const std::int64_t index = row.integer(column);
    if (row.type(column) != SQLITE_INTEGER) {
      fail(where + ": expected a whole number, found '" +
           std::string(row.text(column).substr(0, 40)) + "'");
    }
    if (index < std::numeric_limits<std::int32_t>::min() ||
        index > std::numeric_limits<std::int32_t>::max()) {
      fail(where + ": expected an index of 32 bits, found " + std::to_string(index));
    }
    if (std::fabs(static_cast<double>(index) * map_.layers.block_size_m) > kFarthest_m) {
      fail(where + ": block " + std::to_string(index) + " lies over 10,000 km away");
    }
    return static_cast<std::int32_t>(index);
  }

  std::uint32_t zone_of(const NvbloxBlock& b) const {
    if (!options_.zone_at) return 0;
    const double size = map_.layers.block_size_m;
    return std::min(
        options_.zone_at(centre_of(b.x, size), centre_of(b.y, size), centre_of(b.z, size)),
        kNoZone);
  }

  void cut() {
    std::uint32_t part = 0;
    for (std::size_t begin = 0; begin < map_.blocks.size();) {
      std::size_t end = begin + 1;
      while (end < map_.blocks.size() && key_of(map_.blocks[end]) == key_of(map_.blocks[begin])) {
        ++end;
      }
      const NvbloxBlock& first = map_.blocks[begin];
      const bool same_cube = begin > 0 && cube_of(map_.blocks[begin - 1].x) == cube_of(first.x) &&
                             cube_of(map_.blocks[begin - 1].y) == cube_of(first.y) &&
                             cube_of(map_.blocks[begin - 1].z) == cube_of(first.z);
      part = same_cube ? part + 1 : 0;
      NvbloxCube& cube = map_.cubes.emplace_back();
      cube.first = begin;
      cube.count = end - begin;
      cube.id = free_id(wanted_id(first, part));
      place_base(cube);
      find_damage(cube);
      begin = end;
    }
    std::sort(map_.cubes.begin(), map_.cubes.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
  }

  std::int32_t free_id(std::int32_t wanted) {
    if (wanted > 0 && ids_.insert(wanted).second) return wanted;
    while (!ids_.insert(next_free_).second) ++next_free_;
    return next_free_;
  }

  void place_base(NvbloxCube& cube) const {
    const double size = map_.layers.block_size_m;
    const auto own = std::span(map_.blocks).subspan(cube.first, cube.count);
    std::array<double, 3> middle{};
    for (const NvbloxBlock& b : own) {
      middle[0] += b.x;
      middle[1] += b.y;
      middle[2] += b.z;
    }
    for (double& m : middle) m /= static_cast<double>(own.size());
    double nearest = std::numeric_limits<double>::max();
    for (const NvbloxBlock& b : own) {
      const double dx = b.x - middle[0], dy = b.y - middle[1], dz = b.z - middle[2];
      const double square = dx * dx + dy * dy + dz * dz;
      if (square >= nearest) continue;
      nearest = square;
      cube.base = {centre_of(b.x, size), centre_of(b.y, size), centre_of(b.z, size)};
    }
  }

  void find_damage(NvbloxCube& cube) {
    const auto own = std::span(map_.blocks).subspan(cube.first, cube.count);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const NvbloxBlock& b = own[i];
      const std::string table = std::string(kBlockLayerNames[b.layer]) + "_data";
      if (b.wrong_length != 0) {
        auto& row = lengths_[b.layer];
        if (!row) {
          row.emplace(file_, "SELECT length(data) FROM " + table + " WHERE rowid=?1",
                      kLargestValueBytes);
        }
        row->restart(std::int64_t{b.row});
        const auto found = row->step() ? static_cast<std::uint64_t>(row->integer(0)) : 0;
        cube.damage = Damage{cube.id, table, block_text(b) + ": " + length_problem(b.layer, found)};
        return;
      }
      if (i > 0 && own[i - 1].layer == b.layer && place_of(own[i - 1]) == place_of(b)) {
        cube.damage =
            Damage{cube.id, table,
                   block_text(b) + " is there twice, in rows " + std::to_string(own[i - 1].row) +
                       " and " + std::to_string(b.row) + "; expected each index once"};
        return;
      }
    }
  }

  void describe() {
    std::string counts;
    for (std::size_t i = 0; i < kBlockLayerNames.size(); ++i) {
      if (!map_.layers.layers[i]) continue;
      counts += (counts.empty() ? "" : ", ") + std::string(kBlockLayerNames[i]) + " " +
                std::to_string(map_.block_count[i]);
    }
    map_.notes.push_back("blocks: " + counts + "; in " + std::to_string(map_.cubes.size()) +
                         " cubes of at most 8 x 8 x 8 blocks" +
                         (options_.zone_at ? ", cut at the borders of zones" : ""));
  }

  const SqliteFile& file_;
  const SourceOptions& options_;
  NvbloxMap map_;
  std::set<std::int32_t> ids_;
  std::int32_t next_free_ = 1;
  std::array<std::optional<SqliteQuery>, 4> lengths_;
};

}  // namespace

NvbloxMap read_nvblox_map(const SqliteFile& file, const SourceOptions& options) {
  return Reading(file, options).read();
}

std::string block_text(const NvbloxBlock& b) {
  return "block (" + std::to_string(b.x) + ", " + std::to_string(b.y) + ", " + std::to_string(b.z) +
         ")";
}

std::string length_problem(std::size_t layer, std::uint64_t found) {
  return "expected " + std::to_string(block_bytes_of(layer)) + " bytes (512 voxels of " +
         std::to_string(block_bytes_of(layer) / kVoxelsOfBlock) + "), found " +
         std::to_string(found);
}

std::size_t block_bytes_of(std::size_t layer) noexcept {
  return bytes_of_block(planes_of(static_cast<VoxelLayer>(layer)));
}

std::uint32_t place_of(const NvbloxBlock& b) noexcept {
  return place_in_cube(static_cast<std::uint32_t>(b.x & 7), static_cast<std::uint32_t>(b.y & 7),
                       static_cast<std::uint32_t>(b.z & 7));
}

}  // namespace zonepack::packer
