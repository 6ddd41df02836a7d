// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/pack_format/chunk_view.hpp"

// What the command lines of the subcommands share.
namespace zonepack::packer {

// Adds an option that takes a SIZE (byte_count.hpp): bytes, or with a unit.
CLI::Option* add_size_option(CLI::App& app, const std::string& name, ByteCount& target,
                             const std::string& help);

// Adds an option that takes a comma-separated list of payload kinds other than the core.
CLI::Option* add_payload_option(CLI::App& app, const std::string& name, PayloadMask& target,
                                const std::string& help);

// Adds an option that takes one of a few words, each standing for a value.
template <typename Value>
CLI::Option* add_choice_option(CLI::App& app, const std::string& name, Value& target,
                               const std::vector<std::pair<std::string, Value>>& choices,
                               const std::string& help) {
  return app
      .add_option_function<std::string>(
          name,
          [&target, name, choices](const std::string& text) {
            std::string words;
            for (const auto& [word, value] : choices) {
              words += (words.empty() ? "" : ", ") + word;
              if (word != text) continue;
              target = value;
              return;
            }
            throw CLI::ValidationError(name, "'" + text + "' is none of " + words);
          },
          help)
      ->type_name("POLICY");
}

// The destination of --json: FILE, standard output for "-", or nowhere when empty.
class JsonOutput {
 public:
  void add_option(CLI::App& app);
  // The stream for people: standard output, or standard error when JSON goes to standard output.
  std::ostream& text() const;
  // Throws, before a long run, when FILE cannot be written.
  void require_writable() const;
  // Writes the file whole or not at all; throws std::runtime_error when it cannot.
  void write(const nlohmann::ordered_json& json) const;

 private:
  std::string file_;
};

}  // namespace zonepack::packer
