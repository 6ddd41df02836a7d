// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "packer/build/manifest_writer.hpp"

// Mapping sessions (map_id) and the layers that name them.
namespace zonepack::packer {

using SessionCounts = std::map<std::int32_t, std::size_t>;  // signatures of each session

// Reads "NAME=SESSIONS", sessions as numbers and ranges: "rooms=1-3,5". Throws
// std::invalid_argument, a text that says what was expected.
NamedLayer parse_layer(const std::string& text);

// "1-3,5".
std::string sessions_text(const NamedLayer& layer);

// Replaces the layers that have the names of `given` and adds the rest, sorted by name. Throws
// std::runtime_error when a session is in two layers or a name is given twice.
std::vector<NamedLayer> merged_layers(std::vector<NamedLayer> held,
                                      const std::vector<NamedLayer>& given);

// Null when the session is in none.
const NamedLayer* layer_of(const std::vector<NamedLayer>& layers, std::int32_t session) noexcept;

// The layer that most of these signatures belong to, of equals the first by name; empty when none
// does.
std::string most_common_layer(const std::vector<NamedLayer>& layers, const SessionCounts& sessions);

// Which sessions are to be packed.
struct SessionChoice {
  std::vector<std::string> layers;  // only sessions of these; empty: all sessions
  std::set<std::int32_t> dropped;

  bool all() const noexcept { return layers.empty() && dropped.empty(); }
  bool takes(const std::vector<NamedLayer>& known, std::int32_t session) const noexcept;
};

// Throws std::runtime_error when the choice names a layer that is not known, or a session to drop
// that is not there; `where` has them ("map.db").
void require_known(const SessionChoice& choice, const std::vector<NamedLayer>& known,
                   const SessionCounts& sessions, const std::string& where);

}  // namespace zonepack::packer
