// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "platform/base/result.hpp"

namespace zonepack {

// Fills `out` from mapped windows of the file, at most 1 MiB each and one at a time. The kernel is
// given the range that is needed and reads no more. kTruncated with the file's length when it ends
// too early, kIo with errno.
Result<void> copy_mapped(int fd, std::uint64_t offset, std::span<std::byte> out) noexcept;

}  // namespace zonepack
