// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "packer/verify/map_files.hpp"
#include "packer/verify/pack_facts.hpp"
#include "packer/verify/problem.hpp"

namespace zonepack::packer {

// Checks every byte and every claim of one pack: frame, index, both checksums of every chunk, LZ4,
// structure, columns, and that every signature decodes and the index tells the truth about them.
// Adds what is wrong to `problems`, all of it, and goes on where it can. Returns what the pack
// holds when header, index and tail are whole, else nothing.
//
// Memory: the pack's decoded chunks. `name` is for the messages.
std::optional<PackFacts> verify_pack(const MapFile& file, const std::string& name,
                                     Problems& problems);

}  // namespace zonepack::packer
