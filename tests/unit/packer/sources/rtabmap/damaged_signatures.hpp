// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/blob_writer.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"

// The signatures that tests damage, and the damage.
namespace zonepack::packer {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Three signatures with everything in them.
inline test_support::RtabmapFixture three_signatures(const std::string& version = "0.23.8") {
  test_support::RtabmapFixture fixture;
  fixture.version = version;
  for (std::int32_t id = 1; id <= 3; ++id) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.x = static_cast<float>(id);
    recipe.depth = test_support::SignatureRecipe::Depth::kRvl;
    recipe.user_data = recipe.global_descriptor = recipe.sensors = true;
    recipe.neighbours = {id % 3 + 1};
    fixture.signatures.push_back(test_support::make_signature(recipe));
    if (version < "0.18") fixture.signatures.back().calibration.clear();
  }
  return fixture;
}

inline Bytes numbers(std::size_t count, float first = 0.5f) {
  std::vector<float> values(count, 0.5f);
  values[0] = first;
  return test_support::bytes_of(values);
}

}  // namespace zonepack::packer
