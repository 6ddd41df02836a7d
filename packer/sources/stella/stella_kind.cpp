// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/stella/stella_kind.hpp"

#include "packer/sources/sqlite/sqlite_tables.hpp"
#include "packer/sources/stella/stella_msgpack.hpp"
#include "packer/sources/stella/stella_source.hpp"
#include "packer/sources/stella/stella_sqlite.hpp"

namespace zonepack::packer {
namespace {

// A program that ended while it saved leaves some of the tables.
bool is_sqlite(const std::filesystem::path& path) {
  return has_tables(path, {"keyframes"}) || has_tables(path, {"associations"});
}

}  // namespace

const SourceKind kStellaKind = {"stella", "a stella_vslam or OpenVSLAM map (*.msg, *.db)",
                                [](const std::filesystem::path& path) {
                                  return begins_as_stella_msgpack(path) || is_sqlite(path);
                                },
                                [](const SourceOptions& options) -> std::unique_ptr<MapSource> {
                                  return std::make_unique<StellaSource>(
                                      is_sqlite(options.path) ? open_stella_sqlite(options.path)
                                                              : open_stella_msgpack(options.path),
                                      options);
                                },
                                /*takes_placement=*/true};

}  // namespace zonepack::packer
