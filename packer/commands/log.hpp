// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// zonepack log
void add_log_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
