// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <string_view>

// What the command lines of all programs have in common.
namespace zonepack {

// Parses the command line; options may stand before the subcommand or after it, whether they are
// the program's or the subcommand's. Throws CLI::ParseError; of an unknown subcommand or option it
// says so before it misses anything, with the nearest that there is.
void parse_command_line(CLI::App& app, int argc, const char* const* argv);

// Adds an Examples section to the end of the help. A command that is too long for a line goes on in
// the next one, after a backslash: "a \\\n  b".
void add_examples(CLI::App& app, std::initializer_list<std::string_view> commands);

// An option that names a file.
CLI::Option* add_file(CLI::App& app, const char* name, std::string& target, const char* help);

// A text option that is turned into a value by `parse`, or refused with what is expected where that
// returns false.
template <typename Parse>
CLI::Option* add_parsed(CLI::App& app, const char* name, const char* type, const char* help,
                        const char* expected, Parse parse) {
  return app
      .add_option_function<std::string>(
          name,
          [name, expected, parse](const std::string& text) {
            if (!parse(text)) {
              throw CLI::ValidationError(name, "'" + text + "' is not " + expected);
            }
          },
          help)
      ->type_name(type);
}

}  // namespace zonepack
