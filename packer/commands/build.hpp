// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// `zonepack build`: builds a map from a database and a zone file.
void add_build_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
