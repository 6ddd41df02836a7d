// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "packer/align/umeyama.hpp"
#include "packer/record/map_source.hpp"
#include "packer/update/map_update.hpp"
#include "packer/update/renumbering.hpp"
#include "packer/zones/zone_plan.hpp"

// The signatures of a database that an update may take into a map.
namespace zonepack::packer {

// Whether signatures of such a source are aligned with a trajectory when they come into a map.
bool aligns(const std::string& kind);

struct Newcomer {
  const NodeOutline* node = nullptr;
  std::int32_t id = 0, session = 0;  // in the map
  Transform T_map_base{};
  std::uint32_t zone = 0;  // of the plan, by the zone-in rule or as an orphan
  bool orphan = false;
  bool held = false;  // the map has this very signature
};

class Newcomers {
 public:
  // Places the database's signatures among the zones of `plan`. Throws std::runtime_error when it
  // has none, when the policy refuses some, or when the trajectory does not align it.
  Newcomers(const MapSource& database, const HeldSignatures& held, const ZonePlan& plan,
            const UpdateOptions& options, const std::vector<NamedLayer>& layers,
            UnlinkedPolicy unlinked);

  const std::vector<Newcomer>& all() const noexcept { return all_; }  // by id in the map
  const Renumbering& numbers() const noexcept { return numbers_; }
  const std::optional<PointFit>& alignment() const noexcept { return alignment_; }
  std::size_t not_chosen() const noexcept { return not_chosen_; }
  std::size_t dropped() const noexcept { return dropped_; }
  const std::vector<std::string>& warnings() const noexcept { return warnings_; }

 private:
  void align_with(const std::filesystem::path& trajectory, const MapOutline& outline,
                  const std::string& database);
  void place_in(const ZonePlan& plan);

  Renumbering numbers_;
  std::optional<PointFit> alignment_;
  std::vector<Newcomer> all_;
  std::size_t not_chosen_ = 0, dropped_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace zonepack::packer
