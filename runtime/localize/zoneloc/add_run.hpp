// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "runtime/localize/run/run_command.hpp"

namespace zonepack::localize {

// The subcommand `run`, which fills `arguments` and sets `command`.
void add_run(CLI::App& app, CameraRunArguments& arguments, std::function<int()>& command);

}  // namespace zonepack::localize
