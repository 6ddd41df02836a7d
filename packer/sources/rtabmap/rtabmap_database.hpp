// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "packer/record/map_source.hpp"
#include "packer/sources/sqlite/sqlite.hpp"

namespace zonepack::packer {

// An RTAB-Map database, schema 0.11 to 0.23, read-only.
//
// Throws DamagedSignature when a signature's values are invalid or are stored on damaged pages of
// the file; read() of other signatures still works. Throws SqliteError for anything else.
//
// Memory: the outline, one signature, and SQLite's page cache of 2 MiB.
// Threads: as MapSource; reopen() opens the file again.
class RtabmapDatabase : public MapSource {
 public:
  explicit RtabmapDatabase(const std::filesystem::path& path);
  ~RtabmapDatabase() override;
  RtabmapDatabase(RtabmapDatabase&&) noexcept;
  RtabmapDatabase& operator=(RtabmapDatabase&&) noexcept;

  std::unique_ptr<MapSource> reopen() const override;
  const MapOutline& outline() const noexcept override;
  void require_unchanged() const override;

  // As stored: scans, grids and user data unzipped; images, depth and calibration checked but
  // unchanged. Reading in order of id into one record costs little more than SQLite and zlib.
  void read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into) override;
  using MapSource::read;

 private:
  class Reader;
  RtabmapDatabase(const std::filesystem::path& path, std::shared_ptr<const MapOutline> outline);

  std::filesystem::path path_;
  std::shared_ptr<const MapOutline> outline_;
  std::unique_ptr<Reader> reader_;
};

}  // namespace zonepack::packer
