// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/settings/settings.hpp"
#include "runtime/settings/yaml_section.hpp"

namespace zonepack {

// The sections can and odometry of a settings file at `path`, with the DBC file that can.dbc names:
// settings.can and settings.odometry. settings.cycle has been read.
void read_odometry(YamlSection& file, const std::string& path, Settings& settings,
                   FaultList& faults);

// `name`, when relative, made relative to the folder of the file at `path`.
std::string beside(const std::string& path, const std::string& name);

}  // namespace zonepack
