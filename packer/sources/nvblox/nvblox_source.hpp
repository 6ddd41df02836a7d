// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "packer/record/map_source.hpp"
#include "packer/record/source_kind.hpp"
#include "packer/sources/nvblox/nvblox_map.hpp"
#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

// An nvblox map (.nvblx, SQLite): TSDF, colour, occupancy and ESDF blocks in the map frame. A
// signature is a cube of 8 x 8 x 8 blocks, or the blocks of it whose centres lie in one zone. The
// file is read block by block.
//
// Memory: the map's index (NvbloxMap), shared by all threads, and one cube.
class NvbloxSource : public MapSource {
 public:
  explicit NvbloxSource(const SourceOptions& options);

  std::unique_ptr<MapSource> reopen() const override;
  const MapOutline& outline() const noexcept override { return *outline_; }
  void require_unchanged() const override { file_.require_unchanged(); }
  using MapSource::read;
  void read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) override;

 private:
  NvbloxSource(const std::filesystem::path& path, std::shared_ptr<const NvbloxMap> map,
               std::shared_ptr<const MapOutline> outline);
  void read_block(const NvbloxCube& cube, const NvbloxBlock& block, BlockLayer& into);

  std::filesystem::path path_;
  SqliteFile file_;
  std::shared_ptr<const NvbloxMap> map_;
  std::shared_ptr<const MapOutline> outline_;
  std::array<std::optional<SqliteQuery>, 4> data_;  // a layer's, when first asked
};

}  // namespace zonepack::packer
