// SPDX-License-Identifier: Apache-2.0
#include "platform/memory/allocation_watch.hpp"

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

thread_local bool watching = false;
thread_local std::uint64_t allocated = 0;

}  // namespace

AllocationWatch::AllocationWatch() noexcept {
  allocated = 0;
  watching = true;
}

AllocationWatch::~AllocationWatch() { watching = false; }

std::uint64_t AllocationWatch::allocations() const noexcept { return allocated; }

void allocation_watch::note() noexcept {
  if (!watching) return;
  ++allocated;
#ifdef ZONEPACK_ABORT_ON_ALLOCATION
  watching = false;
  ZP_REQUIRE(!"a thread that must not allocate did");
#endif
}

}  // namespace zonepack
