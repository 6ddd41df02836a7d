// SPDX-License-Identifier: Apache-2.0
#include "tests/support/memory_folder.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace zonepack::test_support {
namespace {

class MemoryFile : public packer::MapFile {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const override {
    if (offset > bytes_.size() || out.size() > bytes_.size() - offset) {
      return {ErrorCode::kTruncated, static_cast<std::int64_t>(offset)};
    }
    if (!out.empty()) std::memcpy(out.data(), bytes_.data() + offset, out.size());
    return {};
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace

std::vector<std::string> MemoryFolder::names() const {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : files) names.push_back(name);
  return names;
}

Result<std::unique_ptr<packer::MapFile>> MemoryFolder::open(const std::string& name) const {
  const auto found = files.find(name);
  if (found == files.end()) return ErrorCode::kNotFound;
  return std::unique_ptr<packer::MapFile>(std::make_unique<MemoryFile>(found->second));
}

MemoryFolder MemoryFolder::copy_of(const std::filesystem::path& folder) {
  MemoryFolder copy;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      copy.files[entry.path().filename().string()] = read_bytes(entry.path());
    }
  }
  return copy;
}

packer::Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

void write_bytes(const std::filesystem::path& path, const packer::Bytes& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace zonepack::test_support
