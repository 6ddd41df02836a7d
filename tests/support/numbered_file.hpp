// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::test_support {

// The byte at an offset of a numbered file: no two 4 KiB blocks are alike.
constexpr std::byte number_at(std::uint64_t offset) {
  return static_cast<std::byte>((offset * 31 + offset / 4096 * 7 + offset / 262144) & 0xFF);
}

// A file of such bytes in a folder of its own, open for writing.
class NumberedFile {
 public:
  explicit NumberedFile(std::size_t size) {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = number_at(i);
    fd_ = ::open(path().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (::write(fd_, bytes.data(), size) != static_cast<ssize_t>(size)) {
      throw std::runtime_error("cannot write " + path().string());
    }
  }
  ~NumberedFile() { ::close(fd_); }
  NumberedFile(const NumberedFile&) = delete;
  NumberedFile& operator=(const NumberedFile&) = delete;

  std::filesystem::path path() const { return folder_ / "numbers"; }
  int fd() const { return fd_; }
  void cut_to(std::uint64_t size) {
    if (::ftruncate(fd_, static_cast<off_t>(size)) != 0) throw std::runtime_error("cannot cut");
  }

 private:
  TemporaryFolder folder_;
  int fd_ = -1;
};

inline bool are_numbers(std::span<const std::byte> bytes, std::uint64_t offset) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != number_at(offset + i)) return false;
  }
  return true;
}

}  // namespace zonepack::test_support
