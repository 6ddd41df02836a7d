// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace zonepack {

// Read-only view of bytes that someone else owns.
using ByteSpan = std::span<const std::byte>;

}  // namespace zonepack
