// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"
#include "runtime/pack_format/file/checksum.hpp"
#include "runtime/zones/transitions.hpp"

namespace zonepack {

// What Transitions hold, with zones by name: the content of a .zpt file (TRANSITIONS.md). It fits
// every version of the map that it was learned on, as far as zones kept their names.
struct LearnedTransitions {
  Digest16 map_lineage{};
  Digest32 map_version{};          // on which it was learned, or saved last
  Digest16 origin{};               // of the file that a run began with, when it goes on learning
  std::uint32_t steps = 0;         // Transitions::steps()
  std::vector<std::string> zones;  // sorted
  std::vector<Transitions::Context> contexts;  // with indices into `zones` for ZoneIds

  friend bool operator==(const LearnedTransitions& a, const LearnedTransitions& b);
};

// As much of it as fits; contexts of other zones are left out.
void restore(const LearnedTransitions& learned, Transitions& into);

// Without lineage, version and origin.
LearnedTransitions save(const Transitions& transitions);

std::vector<std::byte> write_transitions(const LearnedTransitions& learned);

// kTruncated, kBadMagic, kBadVersion, kBadChecksum, kBadStructure, kBadValue; the message says
// which part, and what was expected, without the file's name.
Outcome<LearnedTransitions> read_transitions(ByteSpan file);

// What a file may be long: names of all zones of the fullest table, and its contexts.
inline constexpr std::size_t kMostTransitionsBytes = std::size_t{2} * 1024 * 1024;

}  // namespace zonepack
