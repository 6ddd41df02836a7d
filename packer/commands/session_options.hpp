// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "packer/build/sessions.hpp"

namespace zonepack::packer {

// Adds --layer, --layers and --drop-session. Both targets outlive the parsing.
void add_session_options(CLI::App& command, std::vector<NamedLayer>& layers, SessionChoice& choice);

}  // namespace zonepack::packer
