// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "platform/base/result.hpp"

// The user and the groups of this process, as the system knows them.
namespace zonepack {

bool is_superuser() noexcept;

// The number of a group. kNotFound: there is none of that name; kIo with errno.
Result<std::uint32_t> group_number(const std::string& name);

}  // namespace zonepack
