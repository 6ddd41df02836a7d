// SPDX-License-Identifier: Apache-2.0
#include "packer/update/renumbering.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

namespace zonepack::packer {
namespace {

constexpr std::int32_t kMostNumber = std::numeric_limits<std::int32_t>::max();

std::int32_t next_after(std::int32_t& last, const char* what) {
  if (last == kMostNumber) {
    throw std::runtime_error(std::string("the map has no free number left for another ") + what +
                             "; build it again from one database");
  }
  return ++last;
}

std::int32_t mapped(const std::map<std::int32_t, std::int32_t>& numbers, std::int32_t number) {
  const auto found = numbers.find(number);
  return found == numbers.end() ? number : found->second;
}

}  // namespace

Renumbering::Renumbering(const HeldSignatures& held, const MapOutline& outline) {
  for (const NodeOutline& node : outline.nodes) shared_ += held.same(node.id, node.stamp);
  std::set<std::int32_t> referred;
  std::int32_t last = 0;
  for (const auto& [id, signature] : held.by_id()) {
    last = std::max(last, id);
    for (const std::int32_t to : signature.links) {
      last = std::max(last, to);
      // A grown database has the very signature that a link of the map refers to.
      if (!grown()) referred.insert(to);
    }
  }
  for (const NodeOutline& node : outline.nodes) last = std::max(last, node.id);
  for (const NodeOutline& node : outline.nodes) {
    const bool taken = held.find(node.id) != nullptr || referred.contains(node.id);
    if (taken && !held.same(node.id, node.stamp)) ids_[node.id] = next_after(last, "signature");
  }
  number_sessions(held, outline);
}

void Renumbering::number_sessions(const HeldSignatures& held, const MapOutline& outline) {
  std::set<std::int32_t> common, all;
  std::int32_t last = 0;
  for (const auto& [session, count] : held.sessions()) last = std::max(last, session);
  for (const NodeOutline& node : outline.nodes) {
    last = std::max(last, node.map_id);
    all.insert(node.map_id);
    if (held.same(node.id, node.stamp)) common.insert(node.map_id);
  }
  for (const std::int32_t session : all) {
    if (!held.sessions().contains(session) || common.contains(session)) continue;
    sessions_[session] = next_after(last, "session");
  }
}

std::int32_t Renumbering::id(std::int32_t of_database) const noexcept {
  return mapped(ids_, of_database);
}

std::int32_t Renumbering::session(std::int32_t of_database) const noexcept {
  return mapped(sessions_, of_database);
}

void Renumbering::apply(SignatureRecord& record) const {
  record.id = id(record.id);
  record.map_id = session(record.map_id);
  for (Link& link : record.links) {
    if (link.to > 0) link.to = id(link.to);
  }
  // As the records of a database come: sorted by type, then target.
  std::stable_sort(record.links.begin(), record.links.end(), [](const Link& a, const Link& b) {
    return a.type != b.type ? a.type < b.type : a.to < b.to;
  });
}

}  // namespace zonepack::packer
