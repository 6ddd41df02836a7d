// SPDX-License-Identifier: Apache-2.0
#include "packer/commands/session_options.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace zonepack::packer {
namespace {

void take_layer(std::vector<NamedLayer>& layers, const std::string& text) {
  try {
    std::vector<NamedLayer> all = layers;
    all.push_back(parse_layer(text));
    layers = merged_layers({}, all);
  } catch (const std::exception& error) {
    throw CLI::ValidationError("--layer", error.what());
  }
}

}  // namespace

void add_session_options(CLI::App& command, std::vector<NamedLayer>& layers,
                         SessionChoice& choice) {
  command
      .add_option_function<std::vector<std::string>>(
          "--layer",
          [&layers](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) take_layer(layers, text);
          },
          "name mapping sessions as a layer, such as skeleton=0 or rooms=1-3,5; may be given again")
      ->type_name("NAME=SESSIONS")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option_function<std::string>(
          "--layers",
          [&choice](const std::string& text) {
            for (std::size_t at = 0; at <= text.size();) {
              const std::size_t end = std::min(text.find(',', at), text.size());
              choice.layers.push_back(text.substr(at, end - at));
              if (choice.layers.back().empty()) {
                throw CLI::ValidationError("--layers", "'" + text +
                                                           "' has an empty name; expected names of "
                                                           "layers, such as skeleton,rooms");
              }
              at = end + 1;
            }
          },
          "take only signatures of sessions in these layers; default: of all sessions")
      ->type_name("NAME,NAME");
  command
      .add_option_function<std::vector<std::int32_t>>(
          "--drop-session",
          [&choice](const std::vector<std::int32_t>& sessions) {
            choice.dropped.insert(sessions.begin(), sessions.end());
          },
          "leave out what this mapping session recorded; may be given again")
      ->type_name("N")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace zonepack::packer
