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
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(begin) % page) % page;
  if (size < before + page) return;
  std::byte* const first = begin + before;
  const std::size_t whole = (size - before) / page * page;
  if (::madvise(first, whole, MADV_POPULATE_WRITE) == 0) return;
  for (std::size_t at = 0; at < whole; at += page) {
    auto* const byte = const_cast<volatile std::byte*>(first + at);
    *byte = *byte;
  }
}

}  // namespace zonepack
