// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <span>
#include <string>

namespace zonepack::packer {

// The folder of a map while a new version of it is written. Packs get names of their own; the
// manifest's rename makes them the map. Without commit() (after an error), the destructor removes
// packs that were not there before, and the folder if it was made for them.
//
// Threads: keep() by any; the rest by one.
class MapFolder {
 public:
  // Creates the folder if needed, and clears it of half-written files that a killed writer left.
  // Throws std::runtime_error when that fails.
  explicit MapFolder(std::filesystem::path path);
  ~MapFolder();

  const std::filesystem::path& path() const noexcept { return path_; }

  // Records a pack that has been written here.
  void keep(const std::string& file);

  // Writes the manifest; true when the folder held the same one already. Packs of earlier manifests
  // stay until pruned; packs that this build wrote and then replaced are removed.
  bool commit(std::span<const std::byte> manifest);

 private:
  void remove_new(const std::set<std::string>& but) noexcept;

  std::filesystem::path path_;
  bool created_ = false;
  std::set<std::string> before_;
  std::set<std::string> written_;
  std::mutex mutex_;
};

}  // namespace zonepack::packer
