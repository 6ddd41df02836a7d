// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

// Counts what the calling thread allocates and frees on the heap during the object's lifetime. Only
// programs linked with allocation_hooks.cpp (zoned is) count; others report zero. In builds with
// ZONEPACK_ABORT_ON_ALLOCATION the first allocation stops the process.
//
// Threads: one object per thread.
class AllocationWatch {
 public:
  AllocationWatch() noexcept;
  ~AllocationWatch();
  AllocationWatch(const AllocationWatch&) = delete;
  AllocationWatch& operator=(const AllocationWatch&) = delete;

  std::uint64_t allocations() const noexcept;
};

namespace allocation_watch {
// For the hooks: records one heap call by this thread.
void note() noexcept;
}  // namespace allocation_watch

}  // namespace zonepack
