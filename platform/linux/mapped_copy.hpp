// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "platform/base/result.hpp"

namespace zonepack {

// Fills `out` from a file's mapped windows of at most 1 MiB, each gone again before the next. The
// kernel is told what is needed and reads no more. kTruncated with the file's length when it ends
// before, kIo with errno.
Result<void> copy_mapped(int fd, std::uint64_t offset, std::span<std::byte> out) noexcept;

}  // namespace zonepack
