// SPDX-License-Identifier: Apache-2.0
#include "platform/command_line/command_line.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace zonepack {
namespace {

using Words = std::vector<const char*>;

bool is_command(const CLI::App& app, const std::string& word) {
  const auto commands = app.get_subcommands([](const CLI::App*) { return true; });
  return std::ranges::any_of(commands,
                             [&](const CLI::App* command) { return command->check_name(word); });
}

// The option of the program or of any of its subcommands; null when there is none.
const CLI::Option* find_option(const CLI::App& app, const std::string& name) {
  if (const CLI::Option* const own = app.get_option_no_throw(name)) return own;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (const CLI::Option* const option = command->get_option_no_throw(name)) return option;
  }
  return nullptr;
}

// The place of the subcommand among the words; their number when there is none.
std::size_t place_of_command(const CLI::App& app, const Words& words) {
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string word = words[i];
    if (is_command(app, word)) return i;
    if (word == "--") break;
    if (!word.starts_with('-') || word.find('=') != std::string::npos) continue;
    const CLI::Option* const option = find_option(app, word);
    if (option == nullptr || option->get_items_expected_max() == 0) continue;
    // Of an option whose value may be left out, a subcommand is not the value.
    const bool may_lack = option->get_items_expected_min() == 0;
    if (i + 1 < words.size() && !(may_lack && is_command(app, words[i + 1]))) ++i;
  }
  return words.size();
}

}  // namespace

void parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  Words words(argv, argv + argc);
  const std::size_t place = place_of_command(app, words);
  if (place < words.size()) {
    const auto command = words.begin() + static_cast<std::ptrdiff_t>(place);
    std::rotate(words.begin() + 1, command, command + 1);
  }
  // So that a subcommand takes the program's options.
  for (CLI::App* const command : app.get_subcommands([](CLI::App*) { return true; })) {
    command->fallthrough();
  }
  app.parse(argc, words.data());
}

void add_examples(CLI::App& app, std::initializer_list<std::string_view> commands) {
  std::string text = app.get_footer();
  text += text.empty() ? "Examples:" : "\n\nExamples:";
  for (const std::string_view command : commands) {
    text += "\n  ";
    for (const char c : command) {
      text += c;
      if (c == '\n') text += "  ";
    }
  }
  app.footer(text);
}

CLI::Option* add_file(CLI::App& app, const char* name, std::string& target, const char* help) {
  return app.add_option(name, target, help)->type_name("FILE");
}

}  // namespace zonepack
