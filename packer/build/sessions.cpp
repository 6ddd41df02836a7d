// SPDX-License-Identifier: Apache-2.0
#include "packer/build/sessions.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "packer/zones/zone_file.hpp"
#include "platform/base/nearest_word.hpp"

namespace zonepack::packer {
namespace {

constexpr char kExpected[] = "expected NAME=SESSIONS, such as skeleton=0 or rooms=1-3,5";

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw std::invalid_argument("'" + text + "' " + why + "; " + kExpected);
}

std::int32_t session_in(std::string_view word, const std::string& text) {
  std::int32_t value = 0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
  if (read.ec != std::errc() || read.ptr != word.data() + word.size() || value < 0) {
    refuse(text, "has '" + std::string(word) + "' where a session's number belongs");
  }
  return value;
}

// Sorts ranges and joins those that touch.
void normalise(NamedLayer& layer) {
  std::ranges::sort(layer.sessions);
  std::vector<std::pair<std::int32_t, std::int32_t>> joined;
  for (const auto& range : layer.sessions) {
    if (!joined.empty() && range.first <= std::int64_t{joined.back().second} + 1) {
      joined.back().second = std::max(joined.back().second, range.second);
    } else {
      joined.push_back(range);
    }
  }
  layer.sessions = std::move(joined);
}

bool holds(const NamedLayer& layer, std::int32_t session) noexcept {
  return std::ranges::any_of(layer.sessions, [session](const auto& range) {
    return range.first <= session && session <= range.second;
  });
}

void refuse_overlap(const NamedLayer& a, const NamedLayer& b) {
  for (const auto& p : a.sessions) {
    for (const auto& q : b.sessions) {
      const std::int32_t first = std::max(p.first, q.first);
      if (first > std::min(p.second, q.second)) continue;
      throw std::runtime_error("session " + std::to_string(first) + " is in layer '" + a.name +
                               "' and in layer '" + b.name +
                               "'; a session belongs to one layer at most, so give both anew with "
                               "--layer");
    }
  }
}

}  // namespace

NamedLayer parse_layer(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse(text, "has no '='");
  NamedLayer layer{text.substr(0, equals), {}};
  if (const auto problem = find_name_problem(layer.name)) {
    refuse(text, "has an unfit name: " + *problem);
  }
  if (layer.name.find(',') != std::string::npos) {
    refuse(text, "has a comma in its name, which separates names in lists of layers");
  }
  std::string_view rest = std::string_view(text).substr(equals + 1);
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    more = comma != std::string_view::npos;
    if (more) rest.remove_prefix(comma + 1);
    const std::size_t dash = item.find('-');
    const std::int32_t first = session_in(item.substr(0, dash), text);
    const std::int32_t last =
        dash == std::string_view::npos ? first : session_in(item.substr(dash + 1), text);
    if (last < first) refuse(text, "has a range that ends before it begins");
    layer.sessions.emplace_back(first, last);
  }
  normalise(layer);
  if (layer.sessions.size() > kMaxSessionRanges) {
    refuse(text, "has " + std::to_string(layer.sessions.size()) + " ranges, more than the " +
                     std::to_string(kMaxSessionRanges) + " of the format");
  }
  return layer;
}

std::string sessions_text(const NamedLayer& layer) {
  std::string text;
  for (const auto& [first, last] : layer.sessions) {
    if (!text.empty()) text += ",";
    text += std::to_string(first);
    if (last != first) text += "-" + std::to_string(last);
  }
  return text;
}

std::vector<NamedLayer> merged_layers(std::vector<NamedLayer> held,
                                      const std::vector<NamedLayer>& given) {
  std::set<std::string> names;
  for (const NamedLayer& layer : given) {
    if (!names.insert(layer.name).second) {
      throw std::runtime_error("layer '" + layer.name +
                               "' is given twice; list its sessions in one --layer, such as " +
                               layer.name + "=1-3,5");
    }
    std::erase_if(held, [&](const NamedLayer& other) { return other.name == layer.name; });
    held.push_back(layer);
  }
  std::ranges::sort(held, {}, &NamedLayer::name);
  for (std::size_t i = 0; i < held.size(); ++i) {
    for (std::size_t j = i + 1; j < held.size(); ++j) refuse_overlap(held[i], held[j]);
  }
  if (held.size() > kMaxLayers) {
    throw std::runtime_error(std::to_string(held.size()) + " layers, the format holds at most " +
                             std::to_string(kMaxLayers) + "; give several sessions one name");
  }
  return held;
}

const NamedLayer* layer_of(const std::vector<NamedLayer>& layers, std::int32_t session) noexcept {
  for (const NamedLayer& layer : layers) {
    if (holds(layer, session)) return &layer;
  }
  return nullptr;
}

std::string most_common_layer(const std::vector<NamedLayer>& layers,
                              const SessionCounts& sessions) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [session, count] : sessions) {
    if (const NamedLayer* const layer = layer_of(layers, session)) counts[layer->name] += count;
  }
  std::string name;
  std::size_t most = 0;
  for (const auto& [layer, count] : counts) {
    if (count > most) {
      most = count;
      name = layer;
    }
  }
  return name;
}

bool SessionChoice::takes(const std::vector<NamedLayer>& known,
                          std::int32_t session) const noexcept {
  if (dropped.contains(session)) return false;
  if (layers.empty()) return true;
  const NamedLayer* const layer = layer_of(known, session);
  return layer != nullptr && std::ranges::find(layers, layer->name) != layers.end();
}

void require_known(const SessionChoice& choice, const std::vector<NamedLayer>& known,
                   const SessionCounts& sessions, const std::string& where) {
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const NamedLayer& layer : known) names.push_back(layer.name);
  for (const std::string& name : choice.layers) {
    if (std::ranges::find(names, name) != names.end()) continue;
    throw std::runtime_error(
        "--layers names '" + name + "', " +
        (names.empty() ? "but no layer is named; give --layer " + name + "=SESSIONS as well"
                       : "which no --layer names" + known_words_text(name, names)));
  }
  for (const std::int32_t session : choice.dropped) {
    if (sessions.contains(session)) continue;
    std::string have;
    for (const auto& [other, count] : sessions) {
      have += (have.empty() ? "" : ", ") + std::to_string(other);
    }
    throw std::runtime_error(where + ": has no session " + std::to_string(session) +
                             ", which --drop-session names; it has " +
                             (have.empty() ? "none" : have));
  }
}

}  // namespace zonepack::packer
