// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "runtime/settings/yaml_section.hpp"

namespace zonepack {

// Keys, values and lists of one file. A robot's settings have some hundreds.
inline constexpr std::size_t kMaxYamlNodes = 20'000;

// Whether the text has at most kMaxYamlNodes, counted before a tree of them is built; adds a fault
// otherwise. Throws YAML::Exception as the parser does.
bool fits_yaml_limits(const std::string& text, FaultList& faults);

}  // namespace zonepack
