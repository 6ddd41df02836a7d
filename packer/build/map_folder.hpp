// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <span>
#include <string>

namespace zonepack::packer {

// The folder of a map while a new version of it is written. Packs come under names of their own;
// the manifest's rename makes them the map. Without commit (an error), packs that were not there
// before are removed. Threads: keep() from any; the rest from one.
class MapFolder {
 public:
  // Creates the folder when it is missing. Throws std::runtime_error when that fails.
  explicit MapFolder(std::filesystem::path path);
  ~MapFolder();

  const std::filesystem::path& path() const noexcept { return path_; }

  // Tells of a pack that has been written here.
  void keep(const std::string& file);

  // Writes the manifest; true when the same stood there already. Packs of no manifest stay until
  // pruned, those that only this build tried and gave up are removed.
  bool commit(std::span<const std::byte> manifest);

 private:
  void remove_new(const std::set<std::string>& but) noexcept;

  std::filesystem::path path_;
  std::set<std::string> before_;
  std::set<std::string> written_;
  std::mutex mutex_;
};

}  // namespace zonepack::packer
