// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "packer/record/record.hpp"
#include "packer/sources/damage.hpp"
#include "packer/sources/map_outline.hpp"
#include "packer/sources/sqlite.hpp"

namespace zonepack::packer {

// An RTAB-Map database, schema 0.11 to 0.23, read-only. One object serves one thread; another
// thread takes its own with reopen(), which shares the outline and costs a file open.
//
// What it throws: DamagedSignature when a signature's values are not what they must be, or stand on
// damaged pages of the file; read() of others goes on working. SqliteError for anything else.
// Memory: the outline, one signature, and SQLite's page cache of 2 MiB.
class RtabmapDatabase {
 public:
  explicit RtabmapDatabase(const std::filesystem::path& path);
  ~RtabmapDatabase();
  RtabmapDatabase(RtabmapDatabase&&) noexcept;
  RtabmapDatabase& operator=(RtabmapDatabase&&) noexcept;

  RtabmapDatabase reopen() const;

  const MapOutline& outline() const noexcept;

  // Reads one signature of the outline, with the payloads wanted. Everything is taken as stored:
  // scans, grids and user data unzipped, images, depth and calibration checked but untouched.
  // `into` is replaced; its memory is reused, so reading in order of id into the same record costs
  // little more than SQLite and zlib themselves.
  void read(std::int32_t id, const PayloadSet& wanted, SignatureRecord& into);
  SignatureRecord read(std::int32_t id, const PayloadSet& wanted);

 private:
  class Reader;
  RtabmapDatabase(const std::filesystem::path& path, std::shared_ptr<const MapOutline> outline);

  std::filesystem::path path_;
  std::shared_ptr<const MapOutline> outline_;
  std::unique_ptr<Reader> reader_;
};

}  // namespace zonepack::packer
