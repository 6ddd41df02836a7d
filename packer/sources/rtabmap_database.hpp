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

// An RTAB-Map database, schema 0.11 to 0.23, read-only.
//
// Throws DamagedSignature when a signature's values are invalid or are stored on damaged pages of
// the file; read() of other signatures still works. Throws SqliteError for anything else.
//
// Memory: the outline, one signature, and SQLite's page cache of 2 MiB.
// Threads: one per object; another thread gets its own by reopen(), which shares the outline and
// opens the file again.
class RtabmapDatabase {
 public:
  explicit RtabmapDatabase(const std::filesystem::path& path);
  ~RtabmapDatabase();
  RtabmapDatabase(RtabmapDatabase&&) noexcept;
  RtabmapDatabase& operator=(RtabmapDatabase&&) noexcept;

  RtabmapDatabase reopen() const;

  const MapOutline& outline() const noexcept;

  // Throws SqliteError when the file changed since it was first opened.
  void require_unchanged() const;

  // Reads one signature of the outline with the wanted payloads, as stored: scans, grids and user
  // data unzipped; images, depth and calibration checked but unchanged. Replaces `into` and reuses
  // its memory, so that reading in order of id into one record costs little more than SQLite and
  // zlib.
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
