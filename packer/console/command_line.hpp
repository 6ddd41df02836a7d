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

// What the subcommands share of their command lines.
namespace zonepack::packer {

// Adds an option that takes a SIZE: integer bytes, or with suffix KiB, MiB, GiB.
CLI::Option* add_size_option(CLI::App& app, const std::string& name, ByteCount& target,
                             const std::string& help);

// Adds an option that takes a comma-separated list of payload kinds other than the core.
CLI::Option* add_payload_option(CLI::App& app, const std::string& name, PayloadMask& target,
                                const std::string& help);

// Adds an option that takes one of a few words, each of which stands for a value.
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

// "features,scan,grid".
std::string payload_text(PayloadMask mask);

// Where --json goes: FILE, or standard output for "-", or nowhere when empty.
class JsonOutput {
 public:
  void add_option(CLI::App& app);
  // Text for people: standard output, unless JSON has taken it.
  std::ostream& text() const;
  // Writes the file whole or not at all; throws std::runtime_error when it cannot.
  void write(const nlohmann::ordered_json& json) const;

 private:
  std::string file_;
};

}  // namespace zonepack::packer
