// SPDX-License-Identifier: Apache-2.0
#include "packer/verify/map_files.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "platform/files/storage.hpp"

namespace zonepack::packer {
namespace {

class DiskFile : public MapFile {
 public:
  explicit DiskFile(StorageFile file) : file_(std::move(file)) {}
  std::uint64_t size() const override { return file_.size(); }
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const override {
    return file_.read_at(offset, out);
  }

 private:
  StorageFile file_;
};

}  // namespace

FolderFiles::FolderFiles(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder_, error)) {
    throw std::runtime_error(folder_.string() +
                             ": no such folder; give the folder that 'zonepack build' wrote");
  }
}

std::vector<std::string> FolderFiles::names() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Result<std::unique_ptr<MapFile>> FolderFiles::open(const std::string& name) const {
  Result<StorageFile> file = StorageFile::open((folder_ / name).string());
  if (!file) return file.error();
  return std::unique_ptr<MapFile>(std::make_unique<DiskFile>(std::move(*file)));
}

}  // namespace zonepack::packer
