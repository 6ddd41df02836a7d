// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "packer/record/map_outline.hpp"
#include "packer/record/record.hpp"
#include "packer/update/held_signatures.hpp"

namespace zonepack::packer {

// The numbers that signatures and sessions of a database get in a map that holds others already.
//
// A signature with the id and the stamp of one in the map is that one. Any other whose id the map
// holds, or refers to without knowing the database, gets the next free id; a session whose number
// the map holds, of which the two have no signature in common, the next free number. Landmarks keep
// their ids: a tag on a wall is the same for every session.
class Renumbering {
 public:
  Renumbering(const HeldSignatures& held, const MapOutline& outline);

  // The database holds signatures of the map: it is the one that was packed, grown on.
  bool grown() const noexcept { return shared_ > 0; }
  std::size_t shared() const noexcept { return shared_; }

  std::int32_t id(std::int32_t of_database) const noexcept;
  std::int32_t session(std::int32_t of_database) const noexcept;
  // Those that change, by their number in the database.
  const std::map<std::int32_t, std::int32_t>& ids() const noexcept { return ids_; }
  const std::map<std::int32_t, std::int32_t>& sessions() const noexcept { return sessions_; }

  // Gives a record of the database the numbers of the map, in its links too.
  void apply(SignatureRecord& record) const;

 private:
  void number_sessions(const HeldSignatures& held, const MapOutline& outline);

  std::size_t shared_ = 0;
  std::map<std::int32_t, std::int32_t> ids_;
  std::map<std::int32_t, std::int32_t> sessions_;
};

}  // namespace zonepack::packer
