// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "runtime/pack_format/limits.hpp"
#include "tests/support/memory_folder.hpp"

// Maps that ask a reader for more memory than they may have. All digests are right: they are what
// somebody who can write the map's folder can make.
namespace zonepack::test_support {

// A way to ask for too much, and the part of a refusal that names it.
struct HostileKind {
  const char* name;
  const char* file;  // that the refusal names: "manifest.zpm" or ".zpk"
};
std::span<const HostileKind> hostile_kinds();

// The map of this kind, with the lineage given, so that a robot with such a map looks at it.
MemoryFolder hostile_map(const std::string& kind, std::span<const std::uint8_t> lineage);

// A map of one zone, z000000 unless its name is what is measured, that has `found` of what a limit
// counts; nothing else in it is beyond a limit. Not for limits of whole files, which are too long
// to be held in memory, and of slots, which no file states.
MemoryFolder map_that_measures(LimitId id, std::uint64_t found);

}  // namespace zonepack::test_support
