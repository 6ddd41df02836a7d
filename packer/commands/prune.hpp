// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// `zonepack prune`: removes what builds have left behind in a map's folder.
void add_prune_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
