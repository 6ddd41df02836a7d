// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/nvblox/nvblox_kind.hpp"

#include <algorithm>

#include "packer/record/block_layers.hpp"
#include "packer/sources/nvblox/nvblox_source.hpp"
#include "packer/sources/sqlite/sqlite_tables.hpp"

namespace zonepack::packer {
namespace {

// A map that lacks one of its tables is still one.
bool is_nvblox(const std::filesystem::path& path) {
  return std::ranges::any_of(kBlockLayerNames, [&path](const std::string& layer) {
    return has_tables(path, {(layer + "_metadata").c_str()}) ||
           has_tables(path, {(layer + "_data").c_str()});
  });
}

}  // namespace

const SourceKind kNvbloxKind = {"nvblox", "an nvblox map (*.nvblx)", is_nvblox,
                                [](const SourceOptions& options) -> std::unique_ptr<MapSource> {
                                  return std::make_unique<NvbloxSource>(options);
                                }};

}  // namespace zonepack::packer
