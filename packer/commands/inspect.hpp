// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// `zonepack inspect`: shows what a map or a pack consists of.
void add_inspect_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
