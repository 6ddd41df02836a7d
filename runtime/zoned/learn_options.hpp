// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "runtime/learn/learn_command.hpp"

namespace zonepack {

// `zoned learn`: fills the arguments and sets the command, both of which must outlive the app.
void add_learn(CLI::App& app, LearnArguments& arguments, std::function<int()>& command);

}  // namespace zonepack
