// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/spool.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace zonepack::packer {
namespace {

[[noreturn]] void fail(const std::string& folder) {
  throw std::runtime_error(folder + ": a temporary file for points cannot be written there: " +
                           std::strerror(errno) + "; make room, or set TMPDIR to another folder");
}

std::string folder_of_spools() {
  const char* const folder = std::getenv("TMPDIR");
  return folder != nullptr && *folder != '\0' ? folder : "/tmp";
}

}  // namespace

File open_spool() {
  std::string path = folder_of_spools() + "/zonepack-XXXXXX";
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0) fail(folder_of_spools());
  unlink(path.c_str());
  File file(fdopen(descriptor, "w+b"), &std::fclose);
  if (!file) {
    close(descriptor);
    fail(folder_of_spools());
  }
  return file;
}

void read_at(std::FILE* file, std::uint64_t offset, void* into, std::size_t bytes,
             const std::string& name) {
  auto* at = static_cast<char*>(into);
  while (bytes > 0) {
    const ssize_t got = pread(fileno(file), at, bytes, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw std::runtime_error(name + ": cannot be read: " + std::strerror(errno));
    if (got == 0) throw std::runtime_error(name + ": ends too early; copy the file again");
    at += got;
    offset += static_cast<std::uint64_t>(got);
    bytes -= static_cast<std::size_t>(got);
  }
}

void write_at(std::FILE* file, std::uint64_t offset, const void* from, std::size_t bytes) {
  const auto* at = static_cast<const char*>(from);
  while (bytes > 0) {
    const ssize_t put = pwrite(fileno(file), at, bytes, static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) fail(folder_of_spools());
    at += put;
    offset += static_cast<std::uint64_t>(put);
    bytes -= static_cast<std::size_t>(put);
  }
}

}  // namespace zonepack::packer
