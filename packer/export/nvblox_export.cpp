// SPDX-License-Identifier: Apache-2.0
#include "packer/export/nvblox_export.hpp"

#include <sqlite3.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "packer/decode/zone_records.hpp"
#include "packer/record/block_layers.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

struct Close {
  void operator()(sqlite3* handle) const noexcept { sqlite3_close_v2(handle); }
};
struct Finalize {
  void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

bool is_schema(const char* table) {
  return table != nullptr &&
         (std::strcmp(table, "sqlite_master") == 0 || std::strcmp(table, "sqlite_schema") == 0);
}

// SQL that came with a map may do this and nothing else: make the one table that it is for.
int allow_one_table(void* table, int action, const char* first, const char*, const char*,
                    const char*) {
  const bool is_own =
      first != nullptr && sqlite3_stricmp(first, static_cast<const char*>(table)) == 0;
  switch (action) {
    case SQLITE_CREATE_TABLE:
      return is_own ? SQLITE_OK : SQLITE_DENY;
    case SQLITE_CREATE_INDEX:  // of a primary key
      return first != nullptr && std::strncmp(first, "sqlite_autoindex_", 17) == 0 ? SQLITE_OK
                                                                                   : SQLITE_DENY;
    case SQLITE_REINDEX:
      return SQLITE_OK;
    case SQLITE_INSERT:
    case SQLITE_UPDATE:
      return is_schema(first) ? SQLITE_OK : SQLITE_DENY;
    case SQLITE_READ:  // of its own columns, for a primary key
      return is_schema(first) || is_own ? SQLITE_OK : SQLITE_DENY;
    default:
      return SQLITE_DENY;
  }
}

class NvbloxWriter {
 public:
  explicit NvbloxWriter(const std::string& out)
      : out_(out), part_(out + ".part-" + std::to_string(getpid()) + "-0") {
    std::filesystem::remove(part_);
    sqlite3* handle = nullptr;
    const int code = sqlite3_open_v2(part_.c_str(), &handle,
                                     SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
    handle_.reset(handle);
    if (code != SQLITE_OK) fail(sqlite3_errstr(code));
    sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    run("PRAGMA journal_mode=MEMORY; BEGIN");
  }
  ~NvbloxWriter() {
    std::error_code ignored;
    if (!part_.empty()) std::filesystem::remove(part_, ignored);
  }

  bool has_tables() const { return !info_.empty(); }

  // Once, from the first signature; all say the same.
  void create(const Bytes& info) {
    info_ = info;
    const BlockLayers layers = read_block_layers(info);
    for (std::size_t i = 0; i < kVoxelLayers; ++i) {
      if (!layers.layers[i]) continue;
      const std::string name = kBlockLayerNames[i];
      create_table(name + "_metadata", layers.layers[i]->metadata_sql);
      create_table(name + "_data", layers.layers[i]->data_sql);
      for (const auto& row : layers.layers[i]->metadata) insert_metadata(name, row);
      insert_[i] =
          prepare("INSERT INTO " + name +
                  "_data (rowid, index_x, index_y, index_z, data) VALUES (?1,?2,?3,?4,?5)");
    }
  }

  void add(const BlockCube& cube) {
    if (cube.layers_info != info_) {
      throw std::runtime_error("its signatures describe different layers; build the map again");
    }
    for (std::size_t i = 0; i < kVoxelLayers; ++i) {
      const BlockLayer& layer = cube.layers[i];
      if (!layer.place.empty() && !insert_[i]) {
        throw std::runtime_error(std::string("it holds blocks of ") + kBlockLayerNames[i] +
                                 ", which its layers do not name; build the map again");
      }
      const std::size_t bytes = bytes_of_block(kPlanesOfLayer[i]);
      for (std::size_t k = 0; k < layer.place.size(); ++k) {
        const auto xyz = xyz_of_place(layer.place[k]);
        sqlite3_stmt* const insert = insert_[i].get();
        sqlite3_bind_int64(insert, 1, layer.row[k]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          sqlite3_bind_int64(insert, static_cast<int>(axis) + 2,
                             std::int64_t{cube.index[axis]} * kBlockSide + xyz[axis]);
        }
        sqlite3_bind_blob(insert, 5, layer.voxels.data() + k * bytes, static_cast<int>(bytes),
                          SQLITE_STATIC);
        step(insert);
      }
    }
  }

  void commit() {
    run("COMMIT");
    for (Statement& insert : insert_) insert.reset();
    handle_.reset();
    std::error_code error;
    std::filesystem::rename(part_, out_, error);
    if (error) fail(error.message());
    part_.clear();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw std::runtime_error("cannot write " + out_ + ": " + reason +
                             "; check that its folder exists, is writable and has room");
  }
  void run(const char* sql) {
    if (sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
      fail(sqlite3_errmsg(handle_.get()));
    }
  }
  Statement prepare(const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    const char* rest = nullptr;
    const int code = sqlite3_prepare_v2(handle_.get(), sql.c_str(),
                                        static_cast<int>(sql.size()) + 1, &statement, &rest);
    Statement owned(statement);
    if (code != SQLITE_OK || statement == nullptr) refuse_sql();
    for (; *rest != '\0'; ++rest) {
      if (std::isspace(static_cast<unsigned char>(*rest)) == 0 && *rest != ';') refuse_sql();
    }
    return owned;
  }
  [[noreturn]] void refuse_sql() const {
    throw std::runtime_error(std::string("its tables cannot be made again (") +
                             sqlite3_errmsg(handle_.get()) + "); build the map again");
  }
  void step(sqlite3_stmt* statement) {
    if (sqlite3_step(statement) != SQLITE_DONE) fail(sqlite3_errmsg(handle_.get()));
    sqlite3_reset(statement);
  }

  void create_table(std::string name, const std::string& sql) {
    sqlite3_set_authorizer(handle_.get(), allow_one_table, name.data());
    const Statement statement = prepare(sql);
    step(statement.get());
    sqlite3_set_authorizer(handle_.get(), nullptr, nullptr);
  }

  void insert_metadata(const std::string& layer, const std::vector<TableCell>& row) {
    std::string sql = "INSERT INTO " + layer + "_metadata VALUES (?";
    for (std::size_t i = 1; i < row.size(); ++i) sql += ",?";
    const Statement insert = prepare(sql + ")");
    for (std::size_t i = 0; i < row.size(); ++i) {
      const int at = static_cast<int>(i) + 1;
      if (const auto* integer = std::get_if<std::int64_t>(&row[i])) {
        sqlite3_bind_int64(insert.get(), at, *integer);
      } else if (const auto* real = std::get_if<double>(&row[i])) {
        sqlite3_bind_double(insert.get(), at, *real);
      } else if (const auto* text = std::get_if<std::string>(&row[i])) {
        sqlite3_bind_text(insert.get(), at, text->data(), static_cast<int>(text->size()),
                          SQLITE_TRANSIENT);
      } else if (const auto* blob = std::get_if<Bytes>(&row[i])) {
        sqlite3_bind_blob(insert.get(), at,
                          blob->empty() ? static_cast<const void*>("") : blob->data(),
                          static_cast<int>(blob->size()), SQLITE_TRANSIENT);
      }
    }
    step(insert.get());
  }

  std::string out_, part_;
  std::unique_ptr<sqlite3, Close> handle_;
  std::array<Statement, kVoxelLayers> insert_;
  Bytes info_;
};

}  // namespace

void export_nvblox(const MapReader& map, std::span<const ZoneId> zones, const std::string& out) {
  const fb::Manifest& manifest = map.manifest();
  const std::string kind = flatbuffers::GetString(manifest.provenance()->source_kind());
  if (kind != "nvblox") {
    throw std::runtime_error(
        "only a map of kind nvblox is exported as .nvblx, and this one was packed "
        "from kind " +
        kind + "; give --out another ending for JSON lines");
  }
  if ((manifest.payload_mask() & mask_of(fb::PayloadKind::Blocks)) == 0) {
    throw std::runtime_error(
        "the map was packed without its blocks; build it again without "
        "--payload, or with --payload blocks");
  }
  NvbloxWriter writer(out);
  for (const ZoneId id : zones) {
    const fb::Zone& zone = *manifest.zones()->Get(id);
    ZoneRecords records(map, zone, kEveryPayload, 8 * kMiB);
    for (SignatureRecord record; records.next(record);) {
      if (!record.blocks) continue;
      try {
        if (!writer.has_tables()) writer.create(record.blocks->layers_info);
        writer.add(*record.blocks);
      } catch (const std::runtime_error& error) {
        const std::string what = error.what();
        if (what.starts_with("cannot write")) throw;
        throw std::runtime_error(map.pack_path(zone) + ": " + what);
      }
    }
  }
  if (!writer.has_tables()) {
    throw std::runtime_error("the zones chosen hold no blocks; choose others, or leave out --zone");
  }
  writer.commit();
}

}  // namespace zonepack::packer
