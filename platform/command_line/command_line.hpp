// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string_view>

// What the command lines of all programs have in common.
namespace zonepack {

// Parses the command line; options may stand before the subcommand or after it, whether they are
// the program's or the subcommand's. Throws CLI::ParseError.
void parse_command_line(CLI::App& app, int argc, const char* const* argv);

// Adds an Examples section to the end of the help. A command that is too long for a line goes on in
// the next one, after a backslash: "a \\\n  b".
void add_examples(CLI::App& app, std::initializer_list<std::string_view> commands);

}  // namespace zonepack
