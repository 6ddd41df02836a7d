// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "packer/record/map_outline.hpp"
#include "packer/record/record.hpp"
#include "packer/update/held_signatures.hpp"

namespace zonepack::packer {

// The numbers that signatures and sessions of a database get in a map that holds others already.
//
// A signature with the id and the stamp of one in the map is that one, unless most ids that both
// have are of other stamps. Where nothing is known so, a signature is known by its identity, which
// holds where ids change: in a database of which an earlier update gave signatures other ids, and
// in clouds, whose tiles are numbered anew. Any other whose id the map holds, or refers to without
// knowing the database, gets a free id; a session whose number the map holds, of which the two have
// no signature in common, the next free number. Landmarks keep their ids: a tag on a wall is the
// same for every session.
class Renumbering {
 public:
  Renumbering(const HeldSignatures& held, const MapOutline& outline);

  // The database holds signatures of the map: it is the one that was packed, grown on.
  bool grown() const noexcept { return grown_; }
  // Signatures that the database and the map have in common.
  std::size_t shared() const noexcept { return known_.size(); }
  bool shares(const NodeOutline& node) const noexcept;
  // The id that the database gives to a signature of the map; nothing when it has no such one.
  std::optional<std::int32_t> in_database(std::int32_t of_map) const noexcept;

  std::int32_t id(std::int32_t of_database) const noexcept;
  std::int32_t session(std::int32_t of_database) const noexcept;
  // Those that change, by their number in the database.
  const std::map<std::int32_t, std::int32_t>& ids() const noexcept { return ids_; }
  const std::map<std::int32_t, std::int32_t>& sessions() const noexcept { return sessions_; }

  // Gives a record of the database the numbers of the map, in its links too.
  void apply(SignatureRecord& record) const;

 private:
  void find_known_by_id(const HeldSignatures& held, const MapOutline& outline);
  void find_known(const HeldSignatures& held, const MapOutline& outline);
  void number_ids(const HeldSignatures& held, const MapOutline& outline);
  void number_sessions(const HeldSignatures& held, const MapOutline& outline);

  bool grown_ = false;
  std::map<std::int32_t, std::int32_t> known_;  // ids in the database by those in the map
  std::map<std::int32_t, std::int32_t> ids_;
  std::map<std::int32_t, std::int32_t> sessions_;
};

}  // namespace zonepack::packer
