// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace zonepack::packer {

// `zonepack verify`: checks whether a map or a pack is whole; exit code 1 when it is not.
void add_verify_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
