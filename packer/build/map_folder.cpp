// SPDX-License-Identifier: Apache-2.0
#include "packer/build/map_folder.hpp"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "packer/build/leftovers.hpp"
#include "platform/base/failure.hpp"
#include "platform/files/atomic_file.hpp"
#include "platform/files/storage.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {

MapFolder::MapFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  created_ = std::filesystem::create_directories(path_, error);
  if (error || !std::filesystem::is_directory(path_)) {
    throw std::runtime_error(path_.string() + ": cannot create the map's folder: " +
                             (error ? error.message() : "a file of that name exists") +
                             "; give another --out");
  }
  remove_parts_of_killed(path_);
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    before_.insert(entry.path().filename().string());
  }
}

MapFolder::~MapFolder() {
  remove_new({});
  std::error_code holds_a_map;
  if (created_) std::filesystem::remove(path_, holds_a_map);
}

void MapFolder::keep(const std::string& file) {
  const std::lock_guard lock(mutex_);
  written_.insert(file);
}

bool MapFolder::commit(std::span<const std::byte> manifest) {
  const std::string path = (path_ / kManifestName).string();
  const auto old = read_file(path, manifest.size());
  if (old && std::ranges::equal(*old, manifest)) {
    written_.clear();
    return true;
  }
  const std::string_view text(reinterpret_cast<const char*>(manifest.data()), manifest.size());
  if (const Result<void> written = write_file_atomically(path, text); !written) {
    throw std::runtime_error(cannot_write(path, written.error()).message);
  }
  std::set<std::string> used;
  const fb::Manifest& checked = **check_manifest(manifest);
  for (const fb::Zone* zone : *checked.zones()) used.insert(zone->pack()->str());
  remove_new(used);
  return false;
}

void MapFolder::remove_new(const std::set<std::string>& but) noexcept {
  for (const std::string& file : written_) {
    if (before_.contains(file) || but.contains(file)) continue;
    std::error_code ignored;
    std::filesystem::remove(path_ / file, ignored);
  }
  written_.clear();
}

}  // namespace zonepack::packer
