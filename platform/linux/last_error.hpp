// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cerrno>

#include "platform/base/result.hpp"

namespace zonepack {

// Why the last system call of this thread failed.
inline Error last_error() noexcept { return {ErrorCode::kIo, errno}; }

}  // namespace zonepack
