// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace zonepack::packer {

// `zonepack tune DIR --drives FILE... --budget SIZE --out zones.geojson`; sets exit_code when it
// has run.
void add_tune_command(CLI::App& app, int& exit_code);

}  // namespace zonepack::packer
