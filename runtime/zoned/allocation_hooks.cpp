// SPDX-License-Identifier: Apache-2.0
// The heap of glibc, with a note to AllocationWatch in front. Empty under sanitizers, which bring a
// heap of their own.
#include "platform/memory/foreign_heap.hpp"

#ifndef ZONEPACK_FOREIGN_HEAP

#include <cerrno>
#include <cstddef>

#include "platform/memory/allocation_watch.hpp"

using zonepack::allocation_watch::note;

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): names of glibc
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) noexcept {
  note();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  note();
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) noexcept {
  note();
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  note();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  note();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  note();
  void* const made = __libc_memalign(alignment, size);
  if (made == nullptr) return ENOMEM;
  *block = made;
  return 0;
}

void free(void* block) noexcept {
  if (block != nullptr) note();
  __libc_free(block);
}

}  // extern "C"

#endif  // ZONEPACK_FOREIGN_HEAP
