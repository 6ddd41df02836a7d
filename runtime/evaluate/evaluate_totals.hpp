// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/evaluate/evaluation.hpp"

namespace zonepack {

// The runs of all drives that agree in every other choice, added up.
struct Totals {
  Choice choice;  // of the first; its drive means nothing
  ByteCount budget_bytes = 0;
  std::size_t runs = 0;
  std::uint64_t loads = 0, signatures = 0, requests = 0, hits = 0;
  ByteCount bytes_read = 0, bytes_unused = 0;
  double absent_s = 0, blocked_s = 0;
  std::size_t never_localised = 0;  // runs; they count nothing for absent_s
  DriveAccount::Foreseen foreseen;
  LoadTotals farthest, least;
};

// In the order of the first run of each.
std::vector<Totals> totals_of(const std::vector<Choice>& choices,
                              const std::vector<Evaluated>& results);

// As much of the end of a map's or a drive's path as no other has, for people.
std::string short_name(const std::string& path);

}  // namespace zonepack
