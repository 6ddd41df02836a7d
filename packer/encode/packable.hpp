// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "packer/record/record.hpp"

namespace zonepack::packer {

// Why a signature that was read whole cannot be packed.
struct Unpackable {
  std::string column;   // "Node.label"
  std::string problem;  // "has 5000 bytes; a pack holds at most 4096 there"
};

// Checks every limit that one signature alone can break, before a pack takes any of it.
std::optional<Unpackable> find_unpackable(const SignatureRecord& record);

}  // namespace zonepack::packer
