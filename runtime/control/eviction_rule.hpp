// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zonepack {

// Which zone goes when there is no room.
enum class EvictionRule : std::uint8_t {
  kLru,       // the least recently used
  kExpected,  // the one expected to be used last: ExpectedUse
};

}  // namespace zonepack
