// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "packer/record/record.hpp"
#include "packer/verify/map_files.hpp"

namespace zonepack::test_support {

// A map's folder in memory, whose bytes a test may change between reads.
class MemoryFolder : public packer::MapFiles {
 public:
  std::map<std::string, packer::Bytes> files;

  std::vector<std::string> names() const override;
  Result<std::unique_ptr<packer::MapFile>> open(const std::string& name) const override;

  // A copy of a folder's files.
  static MemoryFolder copy_of(const std::filesystem::path& folder);
};

packer::Bytes read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const packer::Bytes& bytes);

}  // namespace zonepack::test_support
