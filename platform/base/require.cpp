// SPDX-License-Identifier: Apache-2.0
#include "platform/base/require.hpp"

#include <cstdio>
#include <cstdlib>

namespace zonepack {

void require_failed(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "zonepack: bug: %s does not hold (%s:%d); please report this\n", condition,
               file, line);
  std::abort();
}

}  // namespace zonepack
