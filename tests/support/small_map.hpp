// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "packer/build/manifest_writer.hpp"
#include "tests/support/memory_folder.hpp"
#include "tests/support/signature_recipe.hpp"

namespace zonepack::test_support {

// Two rooms of 4 m x 4 m, a (x 0 to 4) and b (x 4 to 8), with a door at y 1.5 to 2.5, and the
// content of their manifest, for tests to falsify. Packs hold signatures as the recipes say.
class SmallMap {
 public:
  // Signature 1 in a, 2 in b, linked both ways: a little of every payload kind, compressed chunks
  // and, in a, a raw one. An image that a recipe calls PNG is noise.
  SmallMap();
  // `in_a` and `in_b` in order of id; links between the zones are counted for the edges.
  SmallMap(std::vector<SignatureRecipe> in_a, std::vector<SignatureRecipe> in_b);

  packer::ZonePlan plan;
  std::vector<packer::PackSummary> packs;
  packer::ManifestContent content;
  MemoryFolder folder;  // packs, and the manifest as it was last written

  // Writes the manifest of the content, as it is now, into the folder.
  void write_manifest();

 private:
  void add_zone(const std::string& name, float left, const std::vector<SignatureRecipe>& recipes);
};

// Appends a correct digest to the manifest's bytes, whatever they say.
void seal_manifest(packer::Bytes& file);

}  // namespace zonepack::test_support
