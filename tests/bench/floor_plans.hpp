// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/suggest/free_space.hpp"

// Floor plans that nobody drew, and the rooms in them: for measuring how well rooms are found.
namespace zonepack::bench {

struct PlanRecipe {
  enum class Layout : std::uint8_t { kCorridor, kLoop, kHouse, kLobby };
  Layout layout = Layout::kCorridor;
  std::uint64_t seed = 1;
  bool scanned = false;    // as a robot's laser sees it: ragged walls, specks, leaves of open doors
  bool furnished = false;  // tables, chairs, beds, shelves
  double turned_rad = 0;
};

struct DrawnPlan {
  packer::suggest::FreeSpace space;
  std::vector<std::int32_t> room_of;  // of each cell; -1 where no room is
  std::int32_t rooms = 0;
};

// The same recipe gives the same plan, furnished or not the same rooms. Cells of 5 cm.
DrawnPlan draw_plan(const PlanRecipe& recipe);

std::string name_of(const PlanRecipe& recipe);

}  // namespace zonepack::bench
