// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "packer/tune/changes.hpp"
#include "packer/tune/layout.hpp"
#include "packer/tune/track.hpp"
#include "platform/process/progress.hpp"

// Zones that fit how robots drive, found change by change.
//
// A layout is better when it needs less than the budget, and, where both do, when its drives cost
// less: bytes read from storage, and `load_bytes` more for each load. In each round every cut and
// every merge is tried on the drives. What a change saves on drives that it was not chosen on says
// whether it is made: for each drive in turn, the best cut of a zone is chosen on all others and
// judged on this one. With one drive, its first half chooses and its second half judges. A change
// is made when
//   - the drives it is chosen on cost kLeastGain less,
//   - the drives held out cost less in sum, and no more of them lose than win, and
//   - both hold with its zones packed as a build packs them.
// Zones become one only where that does not raise the smallest budget.
// As long as the smallest budget is above the budget, the change that lowers it most is made; what
// it does to the drives is only reported.
namespace zonepack::packer::tune {

inline constexpr double kLeastGain = 0.005;  // of what the drives cost before

struct Options {
  ByteCount budget = 0;
  ByteCount load_bytes = 0;
  std::size_t most_changes = 20;
  std::size_t cuts = 24;  // of a zone, along its length, and as many across
};

struct Saved {  // negative: costs more
  std::int64_t loads = 0, signatures = 0, stored = 0;
};

struct Judgement {
  Saved training, held_out;
  std::size_t helped = 0, hurt = 0;  // drives held out
};

struct Step {
  Change::Kind kind = Change::Kind::kSplit;
  ChangeNames names;
  std::int64_t smallest_saved = 0;  // bytes
  bool for_budget = false;          // the smallest budget was above the budget
  Judgement judgement;
  std::string reason;  // of a change that was not made
};

struct Total {
  std::size_t zones = 0;
  Smallest smallest;
  std::vector<DriveCost> drives;  // parallel to the tracks
  DriveCost sum;
  // Visits of zones; loads are among them.
  std::vector<std::size_t> visits;
};

struct Tuned {
  Layout layout;
  std::vector<Track> tracks;  // as given, in the zones of the layout
  Total before, after;
  std::vector<Step> made, rejected;
  bool at_limit = false;  // most_changes were made, and more would help
  bool halves = false;    // there was one drive
};

// What zones of some signatures charge when they are packed.
using Weigh = std::function<PackCost(const TunedZone&)>;
// Why a layout is no zone file; empty when it is one.
using Fault = std::function<std::string(const Layout&)>;

// `tracks`: located in the layout; one drive comes as its two halves, with `halves`.
Tuned tune(Layout layout, std::vector<Track> tracks, bool halves,
           std::span<const Signature> signatures, const Options& options, const Weigh& weigh,
           const Fault& fault, Progress& progress);

}  // namespace zonepack::packer::tune
