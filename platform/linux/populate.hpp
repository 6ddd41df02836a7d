// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace zonepack {

// Makes every page of the range present without changing its content: by one system call where the
// kernel can (Linux 5.14), else by one fault per page.
void populate(std::byte* begin, std::size_t size) noexcept;

}  // namespace zonepack
