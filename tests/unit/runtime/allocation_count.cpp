// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/runtime/allocation_count.hpp"

#include <cstdlib>
#include <new>

namespace {

bool g_counting = false;
std::size_t g_allocations = 0;

}  // namespace

void* operator new(std::size_t bytes) {
  if (g_counting) ++g_allocations;
  if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace zonepack::testing_support {

AllocationCount::AllocationCount() {
  g_allocations = 0;
  g_counting = true;
}
AllocationCount::~AllocationCount() { g_counting = false; }
std::size_t AllocationCount::count() const { return g_allocations; }

}  // namespace zonepack::testing_support
