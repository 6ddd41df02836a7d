// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include "packer/sources/cloud/point_stream.hpp"

namespace zonepack::packer {

// A temporary file without a name, in TMPDIR or /tmp: it is gone with the process, however that
// ends. Throws std::runtime_error.
File open_spool();

// Reads exactly `bytes` from an offset; any thread. Throws where the file is shorter.
void read_at(std::FILE* file, std::uint64_t offset, void* into, std::size_t bytes,
             const std::string& name);
void write_at(std::FILE* file, std::uint64_t offset, const void* from, std::size_t bytes);

}  // namespace zonepack::packer
