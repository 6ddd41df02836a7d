// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cinttypes>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>

#include "platform/process/realtime.hpp"

namespace zonepack {
namespace {

// A line of /proc/self/maps.
struct Mapping {
  std::uintptr_t begin = 0, end = 0;
  std::array<char, 5> access{};  // "r-xp"
  unsigned major = 0, minor = 0;
  std::uint64_t inode = 0;  // 0: not of a file
  bool special = false;     // the kernel's own: [vdso], [vvar]

  bool readable() const noexcept { return access[0] == 'r'; }
  bool writable() const noexcept { return access[1] == 'w'; }
  bool shared() const noexcept { return access[3] == 's'; }
  bool same_file(const Mapping& other) const noexcept {
    return inode == other.inode && major == other.major && minor == other.minor;
  }
};

// Calls `take` for every mapping until it returns false.
template <typename Take>
bool each_mapping(Take take) noexcept {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/maps", "re"),
                                                             std::fclose);
  if (!file) return false;
  std::array<char, 512> line;
  bool begins = true;  // a path may be longer than a line
  while (std::fgets(line.data(), line.size(), file.get()) != nullptr) {
    const bool whole = std::strchr(line.data(), '\n') != nullptr;
    Mapping mapping;
    if (begins && std::sscanf(line.data(), "%" SCNxPTR "-%" SCNxPTR " %4s %*x %x:%x %" SCNu64,
                              &mapping.begin, &mapping.end, mapping.access.data(), &mapping.major,
                              &mapping.minor, &mapping.inode) == 6) {
      mapping.special = std::strstr(line.data(), "[v") != nullptr;
      if (!take(mapping)) return true;
    }
    begins = whole;
  }
  return true;
}

// The files whose code a control thread runs: the program's, and those of the C and the mathematics
// library.
class ControlFiles {
 public:
  void note(const Mapping& mapping) noexcept {
    for (std::size_t i = 0; i < code_.size(); ++i) {
      if (mapping.begin <= code_[i] && code_[i] < mapping.end) files_[i] = mapping;
    }
  }
  bool hold(const Mapping& mapping) const noexcept {
    for (const Mapping& file : files_) {
      if (mapping.same_file(file)) return true;
    }
    return false;
  }

 private:
  using MathFunction = double (*)(double);
  std::array<std::uintptr_t, 3> code_ = {
      reinterpret_cast<std::uintptr_t>(&lock_memory_now),
      reinterpret_cast<std::uintptr_t>(&::clock_gettime),
      reinterpret_cast<std::uintptr_t>(static_cast<MathFunction>(&std::floor))};
  std::array<Mapping, 3> files_{};
};

bool is_to_be_locked(const Mapping& mapping, const ControlFiles& files) noexcept {
  if (mapping.special || !mapping.readable()) return false;
  const bool is_constant = mapping.inode != 0 && !mapping.writable() && !mapping.shared();
  return !is_constant || files.hold(mapping);
}

// False once it was unmapped, by another thread.
bool is_mapped(const Mapping& mapping) noexcept {
  // NOLINTNEXTLINE(performance-no-int-to-ptr): an address, as the kernel prints it
  return msync(reinterpret_cast<void*>(mapping.begin), mapping.end - mapping.begin, MS_ASYNC) == 0;
}

}  // namespace

Result<void> lock_memory_now() noexcept {
  ControlFiles files;
  const bool known = each_mapping([&files](const Mapping& mapping) {
    files.note(mapping);
    return true;
  });
  if (!known) {  // no /proc: everything
    if (mlockall(MCL_CURRENT) != 0) return {ErrorCode::kIo, errno};
    return {};
  }
  int error = 0;
  each_mapping([&files, &error](const Mapping& mapping) {
    if (!is_to_be_locked(mapping, files)) return true;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): an address, as the kernel prints it
    if (mlock(reinterpret_cast<const void*>(mapping.begin), mapping.end - mapping.begin) == 0) {
      return true;
    }
    const bool gone = errno == ENOMEM && !is_mapped(mapping);
    error = gone ? 0 : errno;
    return gone;
  });
  if (error != 0) return {ErrorCode::kIo, error};
  return {};
}

void unlock_memory() noexcept { munlockall(); }

}  // namespace zonepack
