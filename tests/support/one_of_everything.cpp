// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "tests/support/blob_writer.hpp"
#include "tests/support/rtabmap_fixture_schema.hpp"
#include "tests/support/signature_recipe.hpp"

namespace zonepack::test_support {
namespace {

using packer::SignatureRecord;
using Depth = SignatureRecipe::Depth;
using Camera = SignatureRecipe::Camera;
using Image = SignatureRecipe::Image;
using Descriptor = packer::Features::DescriptorType;

constexpr std::int32_t kLast = 24;

SignatureRecipe recipe_of(std::int32_t id) {
  SignatureRecipe recipe;
  recipe.id = id;
  recipe.map_id = id <= 16 ? 0 : 1;
  recipe.x = static_cast<float>(id);
  if (id > 1) recipe.neighbours.push_back(id - 1);
  if (id < kLast) recipe.neighbours.push_back(id + 1);
  recipe.scan_format = (id - 1) % 12 + 1;
  return recipe;
}

void vary(SignatureRecipe& recipe) {
  switch (recipe.id) {
    case 2:
      recipe.descriptor = Descriptor::kF32, recipe.descriptor_dim = 128;
      break;  // SIFT
    case 3:
      recipe.descriptor = Descriptor::kF32, recipe.descriptor_dim = 256;
      break;  // SuperPoint
    case 4:
      recipe.descriptor = Descriptor::kNone;
      break;
    case 5:
      recipe.features = 0;
      break;
    case 6:
      recipe.grid_channels = 3;
      break;
    case 7:
      recipe.grid_channels = 4;
      break;
    case 8:
      recipe.grid_channels = 6;
      break;
    case 9:
      recipe.grid_channels = 0;
      break;
    case 10:
      recipe.depth = Depth::kPng16;
      break;
    case 11:
      recipe.depth = Depth::kPngFloat;
      break;
    case 12:
      recipe.depth = Depth::kRvl;
      break;
    case 13:
      recipe.depth = Depth::kRightJpeg, recipe.camera = Camera::kStereo;
      break;
    case 14:
      recipe.camera = Camera::kTwoMono;
      break;
    case 15:
      recipe.camera = Camera::kNone, recipe.image = Image::kNone;
      break;
    case 16:
      recipe.image = Image::kPng;
      break;
    case 17:
      recipe.user_data = true, recipe.label = "dispensary \xc3\xa9";
      break;
    case 18:
      recipe.global_descriptor = true;
      break;
    case 19:
      recipe.sensors = true, recipe.depth = Depth::kPng16;
      break;
    case 20:
      recipe.scan_format = 0, recipe.grid_channels = 0, recipe.features = 0;
      break;
    default:
      break;
  }
}

// Before 0.18 a camera was 18 float32, before 0.11.2 16, a stereo pair 19.
packer::Bytes old_calibration(const FixtureSchema& schema, Camera camera) {
  if (camera == Camera::kNone) return {};
  const packer::Transform local = level_pose(0.25f, 0, 0.5f);
  std::vector<float> values;
  for (int i = 0; i < (camera == Camera::kTwoMono ? 2 : 1); ++i) {
    for (const float value : {385.0f, 385.0f, 319.5f, 239.5f}) values.push_back(value);
    if (camera == Camera::kStereo) values.push_back(0.125f);
    if (schema.since(0, 11, 2)) {
      for (const float value : {640.0f, 480.0f}) values.push_back(value);
    }
    for (const float value : local) values.push_back(value);
  }
  return bytes_of(values);
}

}  // namespace

RtabmapFixture one_of_everything(const std::string& version) {
  const FixtureSchema schema(version);
  RtabmapFixture fixture;
  fixture.version = version;
  for (std::int32_t id = 1; id <= kLast; ++id) {
    SignatureRecipe recipe = recipe_of(id);
    vary(recipe);
    SignatureRecord r = make_signature(recipe);
    if (!schema.since(0, 18, 0)) r.calibration = old_calibration(schema, recipe.camera);
    if (id == 21) r.weight = -1;
    if (id == 22) r.weight = -9;
    if (id == 1) {
      r.links.push_back(make_link(1, 7, level_pose(1, 0)));  // prior: from itself to itself
      r.links.push_back(make_link(1, 9, level_pose(0, 0)));  // gravity
      r.links.push_back(make_link(12, 1, level_pose(11, 0)));
      r.links.back().user_data = packer::Matrix{1, 4, 0, packer::Bytes(4, std::byte{9})};
    }
    if (id == 2 && schema.since(0, 18, 0)) {
      r.links.push_back(make_link(-5, 8, level_pose(2, 1)));  // landmark
      r.links.push_back(make_link(3, 4, packer::Transform{}));
      r.links.back().transform.reset();
    }
    if (id == 20) r.odometry_pose.reset();
    if (id == 16 || id == 23 || id == kLast) r.pose.reset();
    fixture.signatures.push_back(as_schema_holds(std::move(r), version));
  }
  fixture.extra_poses[-5] = level_pose(4, 1);
  fixture.optimised_map =
      packer::OptimisedMap{{2, 3, 1, packer::Bytes(6, std::byte{100})}, -1.5f, -2, 0.05f};
  return fixture;
}

std::vector<SignatureRecord> expected_records(const RtabmapFixture& fixture) {
  std::vector<SignatureRecord> records;
  for (const SignatureRecord& record : fixture.signatures) {
    if (record.weight == -9) continue;
    records.push_back(as_schema_holds(record, fixture.version));
    if (!fixture.optimised_poses) records.back().pose.reset();
  }
  std::sort(records.begin(), records.end(),
            [](const SignatureRecord& a, const SignatureRecord& b) { return a.id < b.id; });
  return records;
}

}  // namespace zonepack::test_support
