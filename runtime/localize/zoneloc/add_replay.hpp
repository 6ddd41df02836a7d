// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "runtime/localize/replay/loop_command.hpp"

namespace zonepack::localize {

// Adds `replay` to the program; when it was asked for, `command` runs it. `arguments` must outlive
// that.
void add_replay(CLI::App& app, LoopArguments& arguments, std::function<int()>& command);
// The same of `check`.
void add_check(CLI::App& app, LoopArguments& arguments, std::function<int()>& command);

}  // namespace zonepack::localize
