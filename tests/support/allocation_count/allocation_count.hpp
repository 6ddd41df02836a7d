// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace zonepack::testing_support {

// Counts what the whole program allocates with new during the object's lifetime.
class AllocationCount {
 public:
  AllocationCount();
  ~AllocationCount();
  std::size_t count() const;
};

}  // namespace zonepack::testing_support
