// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "runtime/pack_format/file/manifest_file.hpp"
#include "runtime/pack_format/file/pack_reader.hpp"

namespace zonepack::packer {

// A packed map opened by a tool: the manifest read and checked whole, packs on request.
// Throws std::runtime_error with a complete message that names the file.
class MapReader {
 public:
  explicit MapReader(std::filesystem::path folder);

  const fb::Manifest& manifest() const noexcept { return *manifest_; }
  ByteSpan manifest_file() const noexcept { return file_; }

  // The zone of this name, or all parts of a zone that was split.
  std::vector<ZoneId> zones_named(const std::string& name) const;

  std::string pack_path(const fb::Zone& zone) const;
  // The pack that the manifest names for the zone, and no other.
  PackReader open_pack(const fb::Zone& zone) const;

  // For errors met while reading what open_pack() gave.
  [[noreturn]] static void fail(const std::string& path, const Error& error);

 private:
  std::filesystem::path folder_;
  std::vector<std::byte> file_;
  const fb::Manifest* manifest_ = nullptr;
};

}  // namespace zonepack::packer
