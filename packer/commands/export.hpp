// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// `zonepack export DIR [--zone Z] --jsonl`: prints what the packs hold, for comparison with the
// database.
void add_export_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
