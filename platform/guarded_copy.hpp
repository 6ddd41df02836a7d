// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace zonepack {

// Copies bytes of a mapped file into private memory. False when some of them are not there (the
// file was cut short, or its storage fails), which a plain copy would pay for with SIGBUS; what
// then stands at `to` is unspecified.
//
// The first call installs a handler of SIGBUS for the process. Faults outside of a running copy go
// to the handler that was there before, or end the process as they would have. A program that
// installs its own handler later must hand on what it does not know.
//
// Threads: any, at the same time; jumps back through thread-local state. No allocation.
bool guarded_copy(std::byte* to, const std::byte* from, std::size_t size) noexcept;

}  // namespace zonepack
