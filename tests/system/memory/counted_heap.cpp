// SPDX-License-Identifier: Apache-2.0
#include "tests/system/memory/counted_heap.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

constexpr std::size_t kMallocHeader = 8;
std::atomic<std::size_t> live{0};
std::atomic<std::size_t> count{0};

void* counted(void* block) {
  if (block == nullptr) std::abort();
  live += malloc_usable_size(block) + kMallocHeader;
  ++count;
  return block;
}

void release(void* block) {
  if (block == nullptr) return;
  live -= malloc_usable_size(block) + kMallocHeader;
  std::free(block);
}

}  // namespace

namespace zonepack::counted_heap {
std::size_t live_bytes() { return live; }
std::size_t allocations() { return count; }
}  // namespace zonepack::counted_heap

void* operator new(std::size_t size) { return counted(std::malloc(size == 0 ? 1 : size)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto align = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(align, (size + align - 1) / align * align));
}
void operator delete(void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }
