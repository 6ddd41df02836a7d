// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace zonepack {

// Bytes that somebody else owns, to be read.
using ByteSpan = std::span<const std::byte>;

}  // namespace zonepack
