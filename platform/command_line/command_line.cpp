// SPDX-License-Identifier: Apache-2.0
#include "platform/command_line/command_line.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "platform/base/nearest_word.hpp"

namespace zonepack {
namespace {

using Words = std::vector<const char*>;

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

bool is_command(const CLI::App& app, const std::string& word) {
  return std::ranges::any_of(commands_of(app),
                             [&](const CLI::App* command) { return command->check_name(word); });
}

// The option of the program or of any of its subcommands; null when there is none.
const CLI::Option* find_option(const CLI::App& app, const std::string& name) {
  if (const CLI::Option* const own = app.get_option_no_throw(name)) return own;
  for (const CLI::App* const command : commands_of(app)) {
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

std::string long_name(const std::string& word) { return word.substr(0, word.find('=')); }

void refuse_option(const CLI::App& command, const CLI::App& app, const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::App* const scope : {&command, &app}) {
    for (const CLI::Option* const option : scope->get_options()) {
      for (const std::string& one : option->get_lnames()) known.push_back("--" + one);
    }
  }
  const std::string* const nearest = nearest_word(name, known);
  const std::string of = &command == &app ? "" : " of " + command.get_name();
  throw CLI::ExtrasError(
      "unknown option " + name + of + (nearest ? "; did you mean " + *nearest + "?" : ""),
      CLI::ExitCodes::ExtrasError);
}

void refuse_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* const command : commands_of(app)) known.push_back(command->get_name());
  throw CLI::ExtrasError("unknown command \"" + word + "\"" + known_words_text(word, known),
                         CLI::ExitCodes::ExtrasError);
}

// Refuses what nobody knows. The words are the program's name, a subcommand unless `command` is the
// program, options, values. Which words are values is only known of options that take a fixed
// number of them; after any other, a word without dashes is nobody's business here.
void refuse_unknown(const CLI::App& app, const CLI::App& command, const Words& words) {
  const auto asks_for_help = [](const std::string& word) {
    return word == "--help" || word == "-h";
  };
  if (std::ranges::any_of(words, asks_for_help)) return;
  bool may_be_value = &command != &app || commands_of(app).empty();
  for (std::size_t i = &command == &app ? 1 : 2; i < words.size(); ++i) {
    const std::string word = words[i];
    if (word == "--") return;
    if (!word.starts_with('-') && !may_be_value) refuse_command(app, word);
    if (!word.starts_with("--")) {
      may_be_value = true;
      continue;
    }
    const std::string name = long_name(word);
    const CLI::Option* option = command.get_option_no_throw(name);
    if (option == nullptr) option = app.get_option_no_throw(name);
    if (option == nullptr) {
      // Without a subcommand it may be one of theirs: that a subcommand is missing matters more.
      if (&command == &app && find_option(app, name) != nullptr) return;
      refuse_option(command, app, name);
    }
    if (word.size() != name.size()) continue;
    const int values = option->get_items_expected_min();
    may_be_value = may_be_value || option->get_items_expected_max() != values;
    i += static_cast<std::size_t>(values);
  }
}

}  // namespace

void parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  Words words(argv, argv + argc);
  const std::size_t place = place_of_command(app, words);
  if (place < words.size()) {
    const auto command = words.begin() + static_cast<std::ptrdiff_t>(place);
    std::rotate(words.begin() + 1, command, command + 1);
  }
  const CLI::App* used = &app;
  // So that a subcommand takes the program's options.
  for (CLI::App* const command : app.get_subcommands([](CLI::App*) { return true; })) {
    command->fallthrough();
    if (place < words.size() && command->check_name(words[1])) used = command;
  }
  refuse_unknown(app, *used, words);
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
