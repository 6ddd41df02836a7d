// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "packer/tune/layout.hpp"
#include "packer/tune/track.hpp"

namespace zonepack::packer::tune {

struct GivenDrives {
  std::vector<DrivenPath> drives;
  std::vector<Track>
      tracks;  // one a drive, in the zones of the layout; of a single one, its halves
  bool halves = false;
  std::vector<std::string> warnings;  // complete sentences
};

// Reads the drives that a tuning is to fit. Throws std::runtime_error naming the file: for one that
// is no drive, is given twice, never enters a zone or has fixes where zones lie above each other;
// for a single drive of which a half enters no second zone; for more than 500 km together.
GivenDrives read_given_drives(const std::vector<std::string>& files, const Layout& layout,
                              const std::string& folder);

}  // namespace zonepack::packer::tune
