// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "packer/zones/findings.hpp"

// GeoJSON as text becomes a list of features that remember their lines.
namespace zonepack::packer {

struct GeoJsonFeature {
  std::size_t index = 0;  // place in the file's list, from 0
  std::size_t line = 0;   // where it begins, from 1
  nlohmann::json value;   // an object
};

// Strict: one FeatureCollection; a key stands once in an object; numbers are finite; the text is
// UTF-8. Whatever is wrong becomes a fault with its line; what can be read is returned all the
// same.
std::vector<GeoJsonFeature> read_features(std::string_view text, Findings& findings);

}  // namespace zonepack::packer
