// SPDX-License-Identifier: Apache-2.0
#include "packer/build/provenance.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "packer/zones/findings.hpp"
#include "packer/zones/zone_file.hpp"

namespace zonepack::packer {
namespace {

constexpr std::array<std::string_view, 3> kOrphans = {"nearest", "drop", "error"};
constexpr std::array<std::string_view, 4> kUnlinked = {"odometry", "drop", "error", "odometry-all"};

// Of the sessions that were chosen; nothing where all were.
std::string choice_text(const SessionChoice& choice) {
  std::string text;
  for (const std::string& layer : choice.layers) {
    text += (text.empty() ? " layers=" : ",") + layer;
  }
  bool first = true;
  for (const std::int32_t session : choice.dropped) {
    text += (first ? " drop_session=" : ",") + std::to_string(session);
    first = false;
  }
  return text;
}

std::string_view value_of(std::string_view options, std::string_view key) {
  const std::size_t at = options.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = options.substr(at + key.size());
  return rest.substr(0, rest.find(' '));
}

template <typename Policy, std::size_t N>
void take(std::string_view word, const std::array<std::string_view, N>& words, Policy& policy) {
  const auto found = std::ranges::find(words, word);
  if (found != words.end()) policy = static_cast<Policy>(found - words.begin());
}

}  // namespace

SourceBytes source_bytes(const MapOutline& outline) noexcept {
  SourceBytes source;
  source.features = outline.feature_count;
  source.feature_rows = outline.feature_bytes;
  source.bytes =
      source.feature_rows + outline.scan_bytes + outline.grid_bytes + outline.block_bytes;
  return source;
}

std::string packing_text(const Packing& packing) {
  return std::string("orphans=")
      .append(kOrphans[static_cast<std::size_t>(packing.orphans)])
      .append(" unlinked=")
      .append(kUnlinked[static_cast<std::size_t>(packing.unlinked)])
      .append(" max_zone_bytes=" + std::to_string(packing.max_zone_bytes))
      .append(" snap=" + number_text(packing.snap_m))
      .append(choice_text(packing.sessions));
}

Packing packing_of(const fb::Manifest& manifest) {
  const std::string options = flatbuffers::GetString(manifest.provenance()->options());
  Packing packing;
  packing.snap_m = kDefaultSnap_m;
  take(value_of(options, "orphans="), kOrphans, packing.orphans);
  take(value_of(options, "unlinked="), kUnlinked, packing.unlinked);
  const std::string_view snap = value_of(options, "snap=");
  std::from_chars(snap.data(), snap.data() + snap.size(), packing.snap_m);
  const std::string_view most = value_of(options, "max_zone_bytes=");
  std::from_chars(most.data(), most.data() + most.size(), packing.max_zone_bytes);
  return packing;
}

}  // namespace zonepack::packer
