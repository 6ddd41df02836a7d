// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/settings/settings.hpp"
#include "runtime/settings/yaml_section.hpp"

namespace zonepack {

// Reads the sections can and odometry of the settings file at `path`, and the DBC file that can.dbc
// names, into settings.can and settings.odometry. settings.cycle must have been read.
void read_odometry(YamlSection& file, const std::string& path, Settings& settings,
                   FaultList& faults);

// `name` as a path; when relative, it is relative to the folder of the file at `path`.
std::string beside(const std::string& path, const std::string& name);

}  // namespace zonepack
