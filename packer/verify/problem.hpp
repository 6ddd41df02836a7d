// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "runtime/pack_format/chunk_view.hpp"

// What is wrong with a map: where, what was expected, and what to do about it.
namespace zonepack::packer {

struct Location {
  std::string file = {};                     // name in the map's folder
  std::string zone = {};                     // empty while unknown
  std::optional<std::uint32_t> chunk = {};   // place in the pack's index
  std::string kind = {};                     // payload kind of the chunk
  std::optional<std::uint64_t> offset = {};  // bytes from the start of the file
};

struct Problem {
  Location place;
  std::string text;         // what was found and what was expected
  std::string remedy;       // what to do
  std::uint64_t count = 1;  // more than 1: it stands for so many that are not listed
};

using Problems = std::vector<Problem>;

// Listed at most of one pack, of what the manifest says of one zone, and of what it says of the
// map; the rest is counted.
inline constexpr std::size_t kMostListed = 20;

// The problem that stands for all that are not listed.
Problem unlisted(Location place, std::uint64_t count);

// For bytes that are not the ones that were written.
inline constexpr const char* kCopyAgain =
    "copy this file again from where the map was built, or build the map again";
// For an intact file of another map or version.
inline constexpr const char* kWrongFile =
    "the pack is of another map or version: copy the folder again from where this manifest was "
    "written";
// For intact files that contradict themselves, which no storage fault explains.
inline constexpr const char* kBuildAgain =
    "the checksums hold, so it was written like this: build the map again with this version";

// "L1-0123.zpk: zone L1, chunk 3 (features) at byte 4711: …; copy this file again …".
std::string to_string(const Problem& problem);

nlohmann::ordered_json to_json(const Problem& problem);

// "features", or the number of a kind that this version does not know.
std::string kind_text(fb::PayloadKind kind);

}  // namespace zonepack::packer
