// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "platform/base/result.hpp"

// The files of a map, from a folder or from memory.
namespace zonepack::packer {

class MapFile {
 public:
  virtual ~MapFile() = default;
  virtual std::uint64_t size() const = 0;
  // Fills all of `out`, or fails.
  virtual Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const = 0;
};

class MapFiles {
 public:
  virtual ~MapFiles() = default;
  // Names of the files there, sorted.
  virtual std::vector<std::string> names() const = 0;
  // kNotFound, kIo.
  virtual Result<std::unique_ptr<MapFile>> open(const std::string& name) const = 0;
};

// The regular files of a folder.
class FolderFiles : public MapFiles {
 public:
  // Throws std::runtime_error when there is no such folder.
  explicit FolderFiles(std::filesystem::path folder);
  std::vector<std::string> names() const override;
  Result<std::unique_ptr<MapFile>> open(const std::string& name) const override;

 private:
  std::filesystem::path folder_;
};

}  // namespace zonepack::packer
