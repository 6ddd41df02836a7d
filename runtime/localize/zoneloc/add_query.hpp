// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "runtime/localize/explain/query_command.hpp"

namespace zonepack::localize {

// The subcommand `query`, which fills `arguments` and sets `command`.
void add_query(CLI::App& app, QueryArguments& arguments, std::function<int()>& command);

}  // namespace zonepack::localize
