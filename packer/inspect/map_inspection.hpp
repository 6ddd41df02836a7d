// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

namespace zonepack::packer {

// Prints the manifest of a map as a table of zones, and returns all of it as JSON. Charged bytes
// are slots x slot size for the default payload. Throws std::runtime_error when the manifest cannot
// be read.
nlohmann::ordered_json inspect_map(const std::string& folder, std::ostream& out);

}  // namespace zonepack::packer
