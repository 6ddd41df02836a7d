// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

// Counts what a program takes from the heap through operator new: linked into a test program, it
// replaces operator new and delete. An allocation counts as what malloc set aside for it and its
// header.
namespace zonepack::counted_heap {

std::size_t live_bytes();
std::size_t allocations();

}  // namespace zonepack::counted_heap
