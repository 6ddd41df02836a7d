// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zonepack {

// Prints the failed condition with its place and stops the process. For bugs, never for bad input.
[[noreturn]] void require_failed(const char* condition, const char* file, int line) noexcept;

}  // namespace zonepack

// On in every build: an invariant that does not hold would mean memory or motion nobody vouches
// for.
#define ZP_REQUIRE(condition) \
  ((condition) ? static_cast<void>(0) : ::zonepack::require_failed(#condition, __FILE__, __LINE__))
