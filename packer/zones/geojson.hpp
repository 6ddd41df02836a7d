// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "packer/zones/findings.hpp"

// Parses GeoJSON into a list of features that know their lines.
namespace zonepack::packer {

// A larger file is no drawing of a building: a hospital of 50 zones has 26 kB.
inline constexpr std::size_t kMaxZoneFileBytes = std::size_t{64} << 20;
inline constexpr std::size_t kMaxJsonValues = 4'000'000;  // numbers, texts, lists, objects
inline constexpr std::size_t kMaxJsonKeys = 10'000;       // of one object

struct GeoJsonFeature {
  std::size_t index = 0;  // index in the file's list, from 0
  std::size_t line = 0;   // where it begins, from 1
  nlohmann::json value;   // an object
};

// Strict: one FeatureCollection; no key twice in an object; finite numbers; UTF-8. Every error
// becomes a fault with its line; the readable features are returned all the same.
std::vector<GeoJsonFeature> read_features(std::string_view text, Findings& findings);

}  // namespace zonepack::packer
