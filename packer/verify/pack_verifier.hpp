// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "packer/verify/map_files.hpp"
#include "packer/verify/pack_facts.hpp"
#include "packer/verify/problem.hpp"

namespace zonepack::packer {

// Checks every byte and every claim of one pack: header, index and tail, both checksums of every
// chunk, LZ4, structure, columns, and that every signature decodes and the index describes them
// correctly. Adds every problem to `problems`, named by `name`, the first kMostListed one by one
// and the rest as a count, and continues where it can. Returns what the pack holds when header,
// index and tail are whole, else nothing.
//
// Memory: the pack's decoded chunks.
std::optional<PackFacts> verify_pack(const MapFile& file, const std::string& name,
                                     Problems& problems);

}  // namespace zonepack::packer
