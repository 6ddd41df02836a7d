// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/shared_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <limits>

#include "platform/base/require.hpp"
#include "platform/linux/last_error.hpp"
#include "platform/linux/populate.hpp"

#ifndef MFD_NOEXEC_SEAL
#define MFD_NOEXEC_SEAL 0x0008U  // Linux 6.3
#endif

namespace zonepack {
namespace {

constexpr int kSizeSeals = F_SEAL_SHRINK | F_SEAL_GROW;

int make_memfd(const char* name) {
  constexpr unsigned kFlags = MFD_CLOEXEC | MFD_ALLOW_SEALING;
  const int fd = ::memfd_create(name, kFlags | MFD_NOEXEC_SEAL);
  return fd >= 0 || errno != EINVAL ? fd : ::memfd_create(name, kFlags);
}

// The size of a file whose seals keep its pages from vanishing.
Result<std::size_t> sealed_size(const Descriptor& file) {
  const int seals = ::fcntl(file.get(), F_GET_SEALS);
  if (seals < 0 || (seals & kSizeSeals) != kSizeSeals) return ErrorCode::kMismatch;
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return last_error();
  if (status.st_size <= 0 ||
      static_cast<std::uint64_t>(status.st_size) > std::numeric_limits<std::size_t>::max()) {
    return ErrorCode::kMismatch;
  }
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

Result<SharedMemory> SharedMemory::create(const char* name, ByteCount bytes) {
  Descriptor file(make_memfd(name));
  if (!file.is_open()) return last_error();
  const auto size = static_cast<off_t>(bytes);
  if (::ftruncate(file.get(), size) != 0 || ::fallocate(file.get(), 0, 0, size) != 0 ||
      ::fchmod(file.get(), 0400) != 0 ||
      ::fcntl(file.get(), F_ADD_SEALS, kSizeSeals | F_SEAL_SEAL) != 0) {
    return last_error();
  }
  return map_writable(std::move(file), bytes);
}

Result<SharedMemory> SharedMemory::adopt(Descriptor file, ByteCount bytes) {
  const Result<std::size_t> size = sealed_size(file);
  if (!size) return size.error();
  if (*size != bytes) return {ErrorCode::kMismatch, static_cast<std::int64_t>(*size)};
  return map_writable(std::move(file), bytes);
}

Result<SharedMemory> SharedMemory::map_writable(Descriptor file, ByteCount bytes) {
  const auto size = static_cast<std::size_t>(bytes);
  void* const begin = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  if (begin == MAP_FAILED) return last_error();
  populate(static_cast<std::byte*>(begin), size);
  return SharedMemory(std::move(file), static_cast<std::byte*>(begin), size, true);
}

Result<SharedMemory> SharedMemory::map_read_only(Descriptor file) {
  const Result<std::size_t> size = sealed_size(file);
  if (!size) return size.error();
  void* const begin = ::mmap(nullptr, *size, PROT_READ, MAP_SHARED, file.get(), 0);
  if (begin == MAP_FAILED) return last_error();
  return SharedMemory(std::move(file), static_cast<std::byte*>(begin), *size, false);
}

SharedMemory::SharedMemory(SharedMemory&& other) noexcept
    : file_(std::move(other.file_)),
      begin_(std::exchange(other.begin_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      writable_(other.writable_) {}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(begin_, other.begin_);
  std::swap(size_, other.size_);
  std::swap(writable_, other.writable_);
  return *this;
}

SharedMemory::~SharedMemory() {
  if (begin_ != nullptr) ::munmap(begin_, size_);
}

std::span<std::byte> SharedMemory::bytes() noexcept {
  ZP_REQUIRE(writable_);
  return {begin_, size_};
}

Result<Descriptor> SharedMemory::reader_file() const {
  char path[40];
  std::snprintf(path, sizeof path, "/proc/self/fd/%d", file_.get());
  Descriptor reader(::open(path, O_RDONLY | O_CLOEXEC));
  if (!reader.is_open()) return last_error();
  return reader;
}

}  // namespace zonepack
