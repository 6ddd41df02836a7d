// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "packer/record/record.hpp"
#include "tests/support/rtabmap_fixture.hpp"

// Signatures made by tests. The same recipe gives the same bits on every machine.
namespace zonepack::test_support {

// A level pose: translation and a turn of a quarter of `quarter_turns` about z, exact in float32.
packer::Transform level_pose(float x, float y, float z = 0, int quarter_turns = 0);

struct SignatureRecipe {
  std::int32_t id = 1;
  std::int32_t map_id = 0;
  float x = 0, y = 0;  // base position in the map frame, metres

  std::size_t features = 20;
  packer::Features::DescriptorType descriptor = packer::Features::DescriptorType::kU8;
  std::uint32_t descriptor_dim = 32;
  bool partial_points = true;  // every 3rd point wholly NULL, every 7th in one coordinate
  bool words_outside = true;   // every 5th word id <= 0

  std::int32_t scan_format = 1;  // 1..12; 0: no scan
  std::int32_t scan_points = 60;
  std::int32_t grid_channels = 2;  // 2: cells on a lattice; 3, 4, 6: in space; 0: no grid

  enum class Image { kNone, kJpeg, kPng } image = Image::kJpeg;
  enum class Depth { kNone, kPng16, kPngFloat, kRvl, kRightJpeg } depth = Depth::kNone;
  enum class Camera { kNone, kMono, kTwoMono, kStereo } camera = Camera::kMono;
  bool user_data = false;
  bool global_descriptor = false;
  bool blocks = false;                   // of voxels: two of TSDF, one of each other layer
  bool sensors = false;                  // velocity, GPS, environment sensors, ground truth
  std::vector<std::int32_t> neighbours;  // links of type 0 to these ids
  std::string label;
};

packer::SignatureRecord make_signature(const SignatureRecipe& recipe);

// A link from a signature, with a symmetric information matrix of powers of two.
packer::Link make_link(std::int32_t to, std::int32_t type, const packer::Transform& transform);

// A database with one signature of every kind that its version can hold, 1 metre apart on the x
// axis, ids 1 to 24: all scan formats, grids and depth encodings, float and binary descriptors,
// landmark, prior and gravity links, an intermediate (weight -1) and a deleted (weight -9) node,
// labels, two sessions, and three nodes without an optimised pose.
RtabmapFixture one_of_everything(const std::string& version);

// What a reader must return for a fixture: sorted by id, without deleted nodes, and only what the
// schema holds.
std::vector<packer::SignatureRecord> expected_records(const RtabmapFixture& fixture);

// The first field in which two records differ, bit for bit ("scan.data"); empty when they are
// equal.
std::string first_difference(const packer::SignatureRecord& a, const packer::SignatureRecord& b);

}  // namespace zonepack::test_support
