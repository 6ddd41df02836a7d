// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace zonepack {

// Calls work(0) to work(count - 1), each once, by `jobs` threads (0: one a core); returns when all
// are done.
void run_jobs(std::size_t count, unsigned jobs, const std::function<void(std::size_t)>& work);

}  // namespace zonepack
