// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/cloud_kinds.hpp"

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "packer/sources/cloud/cloud_files.hpp"
#include "packer/sources/cloud/cloud_source.hpp"
#include "packer/sources/cloud/pcd_header.hpp"
#include "packer/sources/cloud/tiled_cloud.hpp"

namespace zonepack::packer {
namespace {

bool is_pcd(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  std::array<char, 4096> bytes{};
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), bytes.size());
  return begins_as_pcd(
      {bytes.data(), static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0))});
}

std::unique_ptr<MapSource> source(const char* kind, std::unique_ptr<CloudMap> cloud,
                                  const SourceOptions& options) {
  return std::make_unique<CloudSource>(kind, std::move(cloud), options.name());
}

}  // namespace

const SourceKind kPcdKind = {
    "pcd", "a point cloud (*.pcd)", is_pcd,
    [](const SourceOptions& options) { return source("pcd", open_tiled_cloud(options), options); }};

const SourceKind kAutowareKind = {"autoware", "a folder of Autoware's map tiles", is_autoware_tiles,
                                  [](const SourceOptions& options) {
                                    return source("autoware", open_autoware_tiles(options.path),
                                                  options);
                                  }};

const SourceKind kGlimKind = {"glim", "a dump of GLIM", is_glim_dump,
                              [](const SourceOptions& options) {
                                return source("glim", open_glim_dump(options.path), options);
                              }};

}  // namespace zonepack::packer
