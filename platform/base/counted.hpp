// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace zonepack {

// "1 zone", "2 zones"; many: where the plural is not made by an s.
inline std::string counted(std::uint64_t count, const std::string& one,
                           const std::string& many = {}) {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

}  // namespace zonepack
