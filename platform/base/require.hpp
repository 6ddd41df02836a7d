// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zonepack {

// Prints the failed condition with its place and stops the process. For bugs, never for bad input.
[[noreturn]] void require_failed(const char* condition, const char* file, int line) noexcept;

}  // namespace zonepack

// On in every build: with a broken invariant, nothing vouches for memory or motion any more.
#define ZP_REQUIRE(condition) \
  ((condition) ? static_cast<void>(0) : ::zonepack::require_failed(#condition, __FILE__, __LINE__))
