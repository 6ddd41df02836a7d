// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// zonepack update
void add_update_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
