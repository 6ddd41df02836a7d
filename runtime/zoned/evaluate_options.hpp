// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "runtime/evaluate/evaluate_command.hpp"

namespace zonepack {

// `zoned evaluate`: fills the arguments and sets the command, both of which must outlive the app.
void add_evaluate(CLI::App& app, EvaluateArguments& arguments, std::function<int()>& command);

}  // namespace zonepack
