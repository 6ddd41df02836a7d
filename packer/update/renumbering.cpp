// SPDX-License-Identifier: Apache-2.0
#include "packer/update/renumbering.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "packer/record/link_order.hpp"

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
  find_known(held, outline);
  number_ids(held, outline);
  number_sessions(held, outline);
}

void Renumbering::find_known(const HeldSignatures& held, const MapOutline& outline) {
  if (!outline.numbered_anew) find_known_by_id(held, outline);
  if (grown_) return;
  std::map<SignatureIdentity, std::int32_t> by_identity;
  for (const auto& [id, signature] : held.by_id()) {
    if (signature.identity) by_identity[*signature.identity] = id;
  }
  for (const NodeOutline& node : outline.nodes) {
    const auto identity = identity_of(node.stamp, node.label, node.odometry_pose, node.pose);
    if (!identity) continue;
    const auto found = by_identity.find(*identity);
    if (found == by_identity.end() || !known_.try_emplace(found->second, node.id).second) continue;
    if (found->second != node.id) ids_[node.id] = found->second;
  }
  grown_ = outline.numbered_anew && !known_.empty();
}

void Renumbering::find_known_by_id(const HeldSignatures& held, const MapOutline& outline) {
  std::size_t others = 0;
  for (const NodeOutline& node : outline.nodes) {
    const HeldSignatures::Signature* const same = held.find(node.id);
    if (same == nullptr) continue;
    if (same->stamp == node.stamp) {
      known_[node.id] = node.id;
    } else {
      ++others;
    }
  }
  grown_ = known_.size() > others;
  if (!grown_) known_.clear();
}

// All ids that change move by one offset, which a later update finds again, so that links to
// signatures which are packed then lead to them.
void Renumbering::number_ids(const HeldSignatures& held, const MapOutline& outline) {
  std::set<std::int32_t> referred;
  std::int32_t last = 0;
  for (const auto& [id, signature] : held.by_id()) {
    last = std::max(last, id);
    for (const std::int32_t to : signature.links) {
      last = std::max(last, to);
      // A grown database has the very signature that a link of the map refers to.
      if (!grown_) referred.insert(to);
    }
  }
  for (const NodeOutline& node : outline.nodes) last = std::max(last, node.id);
  std::int64_t offset = last;  // so that what it gives is free
  for (const auto& [of_map, of_database] : known_) {
    if (!grown_ && of_map != of_database) offset = std::int64_t{of_map} - of_database;
  }
  const auto taken = [&](std::int32_t id) {
    if (held.find(id) != nullptr) return true;
    if (known_.empty()) return referred.contains(id);
    // Moved by an earlier update, when the map held the id: links lead to where it went.
    const std::int64_t moved = id + offset;
    return moved <= kMostNumber && referred.contains(static_cast<std::int32_t>(moved));
  };
  std::vector<std::int32_t> others;
  for (const NodeOutline& node : outline.nodes) {
    if (shares(node) || !taken(node.id)) continue;
    const std::int64_t moved = node.id + offset;
    const bool free = moved > 0 && moved <= kMostNumber &&
                      held.find(static_cast<std::int32_t>(moved)) == nullptr &&
                      outline.find(static_cast<std::int32_t>(moved)) == nullptr;
    if (!free) {
      others.push_back(node.id);
      continue;
    }
    ids_[node.id] = static_cast<std::int32_t>(moved);
    last = std::max(last, static_cast<std::int32_t>(moved));
  }
  for (const std::int32_t id : others) ids_[id] = next_after(last, "signature");
}

void Renumbering::number_sessions(const HeldSignatures& held, const MapOutline& outline) {
  std::map<std::int32_t, std::int32_t> common;  // of the map, by the database's
  std::set<std::int32_t> all;
  std::int32_t last = 0;
  for (const auto& [session, count] : held.sessions()) last = std::max(last, session);
  for (const NodeOutline& node : outline.nodes) {
    last = std::max(last, node.map_id);
    all.insert(node.map_id);
    if (shares(node)) common.try_emplace(node.map_id, held.find(id(node.id))->session);
  }
  for (const std::int32_t session : all) {
    if (const auto known = common.find(session); known != common.end()) {
      if (known->second != session) sessions_[session] = known->second;
    } else if (held.sessions().contains(session)) {
      sessions_[session] = next_after(last, "session");
    }
  }
}

bool Renumbering::shares(const NodeOutline& node) const noexcept {
  const auto known = known_.find(id(node.id));
  return known != known_.end() && known->second == node.id;
}

std::optional<std::int32_t> Renumbering::in_database(std::int32_t of_map) const noexcept {
  const auto known = known_.find(of_map);
  return known == known_.end() ? std::nullopt : std::optional(known->second);
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
  sort_links(record.links);
}

}  // namespace zonepack::packer
