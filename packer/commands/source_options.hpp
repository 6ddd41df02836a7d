// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "packer/record/source_kind.hpp"

namespace zonepack::packer {

// Adds --db, which is returned and gives `what`, --from, and the options that say where a map
// stands which its SLAM system left in a frame of its own. Wrong values are usage errors.
CLI::Option* add_source_options(CLI::App& command, SourceOptions& source, const std::string& what);

// Adds --slice, for commands that draw a floor plan.
void add_slice_option(CLI::App& command, SourceOptions& source);

}  // namespace zonepack::packer
