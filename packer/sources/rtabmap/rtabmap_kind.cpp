// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_kind.hpp"

#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "packer/sources/sqlite/sqlite_tables.hpp"

namespace zonepack::packer {

const SourceKind kRtabmapKind = {"rtabmap", "an RTAB-Map database (*.db)",
                                 [](const std::filesystem::path& path) {
                                   return has_tables(path, {"Node", "Admin"});
                                 },
                                 [](const SourceOptions& options) -> std::unique_ptr<MapSource> {
                                   return std::make_unique<RtabmapDatabase>(options.path);
                                 }};

}  // namespace zonepack::packer
