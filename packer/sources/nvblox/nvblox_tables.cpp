// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/nvblox/nvblox_tables.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "platform/base/number_text.hpp"

namespace zonepack::packer {
namespace {

constexpr std::size_t kMostInfoBytes = 4096;  // of all layers together, carried by every pack
constexpr std::size_t kMostMetadataRows = 256;
constexpr double kMostBlockSize_m = 1000;

// The CREATE TABLE of each table that may belong to a layer, by its lower-case name.
std::map<std::string, std::string> layer_tables(const SqliteFile& file) {
  std::map<std::string, std::string> tables;
  SqliteQuery row(file,
                  "SELECT lower(name), sql FROM sqlite_master WHERE type='table' LIMIT 10000");
  while (row.step()) {
    const std::string name(row.text(0));
    if (name.ends_with("_data") || name.ends_with("_metadata")) tables[name] = row.text(1);
  }
  return tables;
}

std::optional<std::size_t> column_of(const std::vector<std::string>& columns, const char* name) {
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

[[noreturn]] void fail(const SqliteFile& file, const std::string& what) {
  throw SqliteError(file.name() + ": " + what);
}

std::size_t require_column(const SqliteFile& file, const std::string& table,
                           const std::vector<std::string>& columns, const char* name) {
  if (const auto column = column_of(columns, name)) return *column;
  fail(file,
       table + ": has no column " + name + ", which nvblox writes; save the map again with nvblox");
}

TableCell cell_of(const SqliteQuery& row, int column) {
  switch (row.type(column)) {
    case SQLITE_INTEGER:
      return row.integer(column);
    case SQLITE_FLOAT:
      return row.real(column);
    case SQLITE_TEXT:
      return std::string(row.text(column));
    case SQLITE_BLOB: {
      const auto bytes = row.blob(column);
      return Bytes(bytes.begin(), bytes.end());
    }
    default:
      return {};
  }
}

std::optional<double> number_of(const TableCell& cell) {
  if (const auto* real = std::get_if<double>(&cell)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*integer);
  return std::nullopt;
}

// Reads the metadata; returns the block size that they state.
double read_metadata(const SqliteFile& file, const std::string& table, BlockLayerTables& into) {
  const std::vector<std::string> columns = file.columns(table);
  const std::size_t name = require_column(file, table, columns, "param_name");
  const std::size_t as_float = require_column(file, table, columns, "value_float");
  const auto as_int = column_of(columns, "value_int");
  std::optional<double> block_size;
  bool stated = false;
  SqliteQuery row(file, "SELECT * FROM " + table + " ORDER BY rowid");
  while (row.step()) {
    if (into.metadata.size() == kMostMetadataRows) {
      fail(file, table + ": has more than 256 rows; nvblox writes a few");
    }
    auto& cells = into.metadata.emplace_back();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      cells.push_back(cell_of(row, static_cast<int>(i)));
    }
    const auto* const parameter = std::get_if<std::string>(&cells[name]);
    if (parameter == nullptr || *parameter != "block_size") continue;
    stated = true;
    block_size = number_of(cells[as_float]);
    if (!block_size && as_int) block_size = number_of(cells[*as_int]);
  }
  if (!stated) {
    fail(file, table +
                   ": has no row block_size, so nothing says where its blocks lie; save the "
                   "map again with nvblox");
  }
  if (!block_size || !(*block_size > 0) || !(*block_size <= kMostBlockSize_m)) {
    fail(file, table + ": block_size: expected metres over 0 and up to 1000, found " +
                   (block_size ? shortest_number(*block_size)
                               : std::string("NULL, as SQLite stores a NaN, or no number")));
  }
  return *block_size;
}

void require_block_columns(const SqliteFile& file, const std::string& table,
                           std::vector<std::string>& warnings) {
  static constexpr const char* kColumns[] = {"index_x", "index_y", "index_z", "data"};
  const std::vector<std::string> columns = file.columns(table);
  for (const char* column : kColumns) require_column(file, table, columns, column);
  for (const std::string& column : columns) {
    if (std::ranges::find(kColumns, column) != std::end(kColumns)) continue;
    warnings.push_back(file.name() + ": " + table + ": column " + column +
                       " is none that nvblox writes; it is left out");
  }
}

}  // namespace

NvbloxTables read_nvblox_tables(const SqliteFile& file) {
  NvbloxTables out;
  const std::map<std::string, std::string> tables = layer_tables(file);
  const char* first = nullptr;
  for (std::size_t i = 0; i < kBlockLayerNames.size(); ++i) {
    const std::string layer = kBlockLayerNames[i];
    const auto metadata = tables.find(layer + "_metadata"), data = tables.find(layer + "_data");
    if (metadata == tables.end() && data == tables.end()) {
      if (i > 0) continue;
      fail(file,
           "has no TSDF layer (tables tsdf_layer_metadata and tsdf_layer_data), without which "
           "nvblox itself loads no map; save the map again with nvblox");
    }
    for (const char* part : {"_metadata", "_data"}) {
      if (tables.contains(layer + part)) continue;
      fail(file, "has " + layer + " without its table " + layer + part +
                     ", as a program that ended while it saved leaves it; save the map again");
    }
    BlockLayerTables& own = out.layers.layers[i].emplace();
    own.metadata_sql = metadata->second;
    own.data_sql = data->second;
    const double size = read_metadata(file, metadata->first, own);
    require_block_columns(file, data->first, out.warnings);
    if (first == nullptr) {
      first = kBlockLayerNames[i];
      out.layers.block_size_m = size;
    } else if (size != out.layers.block_size_m) {
      fail(file, layer + "_metadata: block_size: expected " +
                     shortest_number(out.layers.block_size_m) + " m as in " + first + ", found " +
                     shortest_number(size) +
                     "; blocks of different sizes cannot be packed together");
    }
  }
  for (const auto& [name, sql] : tables) {
    const std::string layer = name.substr(0, name.rfind('_'));
    if (!name.ends_with("_data") || !tables.contains(layer + "_metadata") ||
        std::ranges::find(kBlockLayerNames, layer) != kBlockLayerNames.end()) {
      continue;
    }
    out.warnings.push_back(file.name() + ": " + layer +
                           " is a layer that is not packed yet; it is left out");
  }
  if (const std::size_t bytes = write_block_layers(out.layers).size(); bytes > kMostInfoBytes) {
    fail(file, "its tables and metadata of layers take " + std::to_string(bytes) +
                   " bytes, a pack carries 4096; nvblox writes a few hundred");
  }
  return out;
}

}  // namespace zonepack::packer
