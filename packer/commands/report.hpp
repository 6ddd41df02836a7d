// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "runtime/report/pack_report.hpp"

namespace zonepack::packer {

// Reads the manifest of a packed map for drawing. Throws with a complete message.
report::PackReport read_pack_report(const std::string& folder);

// `zonepack report DIR --out FILE.html|.png|.svg`; sets exit_code when it ran.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
