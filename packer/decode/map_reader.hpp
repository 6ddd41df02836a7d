// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"

namespace zonepack::packer {

// What stands where a manifest or a pack was expected, when its first bytes show it: "is a Git LFS
// pointer, ...", with what to do. Empty for a file of its kind (which may be damaged) or of none.
std::string misplaced_map_file(const std::string& path);

// A packed map opened by a tool: reads and checks the whole manifest at once, packs on request.
// Throws std::runtime_error with a complete message that names the file.
class MapReader {
 public:
  explicit MapReader(std::filesystem::path folder);

  const fb::Manifest& manifest() const noexcept { return *manifest_; }
  ByteSpan manifest_file() const noexcept { return file_; }

  // The zone of this name, or all parts of a zone that was split.
  std::vector<ZoneId> zones_named(const std::string& name) const;

  std::string pack_path(const fb::Zone& zone) const;
  // Opens the pack that the manifest names for the zone; refuses any other.
  PackReader open_pack(const fb::Zone& zone) const;

  // Throws for an error of `path`, such as a pack from open_pack().
  [[noreturn]] static void fail(const std::string& path, const Error& error);

 private:
  std::filesystem::path folder_;
  std::vector<std::byte> file_;
  const fb::Manifest* manifest_ = nullptr;
};

}  // namespace zonepack::packer
