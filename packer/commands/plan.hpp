// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// `zonepack plan DIR`: shows what a map costs in memory and what a budget allows; exit code 1 when
// the given budget is below the smallest.
void add_plan_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
