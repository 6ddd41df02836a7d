// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

namespace zonepack::packer {

// Prints the index of a pack as a table of chunks with their places in slots when the default
// payload is loaded, and returns all of it as JSON. Throws std::runtime_error when the index cannot
// be read.
nlohmann::ordered_json inspect_pack(const std::string& path, std::ostream& out);

}  // namespace zonepack::packer
