// SPDX-License-Identifier: Apache-2.0
#include "platform/linux/populate.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>

#ifndef MADV_POPULATE_WRITE
#define MADV_POPULATE_WRITE 23  // Linux 5.14
#endif

namespace zonepack {

void populate(std::byte* begin, std::size_t size) noexcept {
  if (size == 0) return;
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t before = reinterpret_cast<std::uintptr_t>(begin) % page;
  if (::madvise(begin - before, before + size, MADV_POPULATE_WRITE) == 0) return;
  const auto touch = [begin](std::size_t at) {
    auto* const byte = const_cast<volatile std::byte*>(begin + at);
    *byte = *byte;
  };
  for (std::size_t at = 0; at < size; at += page) touch(at);
  touch(size - 1);
}

}  // namespace zonepack
