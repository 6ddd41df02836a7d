// SPDX-License-Identifier: Apache-2.0
#include "tests/support/allocation_count/allocation_count.hpp"

#include <cstdlib>
#include <new>

namespace {

bool g_counting = false;
std::size_t g_allocations = 0;

void* counted(std::size_t bytes) noexcept {
  if (g_counting) ++g_allocations;
  return std::malloc(bytes == 0 ? 1 : bytes);
}

void* counted_or_throw(std::size_t bytes) {
  if (void* memory = counted(bytes)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// Replaces all forms, so that each allocation is freed by its own kind under sanitizers, too.
void* operator new(std::size_t bytes) { return counted_or_throw(bytes); }
void* operator new[](std::size_t bytes) { return counted_or_throw(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept { return counted(bytes); }
void* operator new[](std::size_t bytes, const std::nothrow_t&) noexcept { return counted(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

namespace zonepack::testing_support {

AllocationCount::AllocationCount() {
  g_allocations = 0;
  g_counting = true;
}
AllocationCount::~AllocationCount() { g_counting = false; }
std::size_t AllocationCount::count() const { return g_allocations; }

}  // namespace zonepack::testing_support
