// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace zonepack {

// Copies bytes of a mapped file into private memory. Returns false when some of them cannot be read
// (the file was truncated, or its storage fails), where a plain copy would raise SIGBUS; the
// content of `to` is then unspecified.
//
// The first call installs a SIGBUS handler for the process. Faults outside a running copy go to the
// previous handler, or end the process as they would have. A program that installs its own handler
// later must pass on the faults that it does not recognise.
//
// Real-time: no allocation.
// Threads: any number at the same time; each jumps back through thread-local state.
bool guarded_copy(std::byte* to, const std::byte* from, std::size_t size) noexcept;

}  // namespace zonepack
