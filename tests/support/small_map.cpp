// SPDX-License-Identifier: Apache-2.0
#include "tests/support/small_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/support/temporary_folder.hpp"

namespace zonepack::test_support {
namespace {

SignatureRecipe tiny(std::int32_t id, float x, std::int32_t neighbour) {
  SignatureRecipe recipe;
  recipe.id = id;
  recipe.x = x;
  recipe.y = 2;
  recipe.features = 3;
  recipe.descriptor_dim = 8;
  recipe.scan_points = 80;
  recipe.depth = SignatureRecipe::Depth::kPng16;
  recipe.user_data = true;
  recipe.neighbours = {neighbour};
  if (id == 1) recipe.image = SignatureRecipe::Image::kPng;
  recipe.blocks = id == 1;
  return recipe;
}

packer::Bytes noise(std::size_t size) {
  std::mt19937_64 engine(1);
  packer::Bytes bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(engine() & 0xFF);
  return bytes;
}

}  // namespace

SmallMap::SmallMap() : SmallMap({tiny(1, 2, 2)}, {tiny(2, 6, 1)}) {}

SmallMap::SmallMap(std::vector<SignatureRecipe> in_a, std::vector<SignatureRecipe> in_b) {
  add_zone("a", 0, in_a);
  add_zone("b", 4, in_b);
  plan.portals.push_back({"a-b", 0, 1, {{4, 1.5}, {4, 2.5}}});

  std::uint32_t links = 0;
  const auto count = [&](const auto& from, const auto& to) {
    for (const SignatureRecipe& recipe : from) {
      for (const std::int32_t id : recipe.neighbours) {
        links += static_cast<std::uint32_t>(
            std::ranges::count(to, id, [](const SignatureRecipe& other) { return other.id; }));
      }
    }
  };
  count(in_a, in_b);
  count(in_b, in_a);
  if (links > 0) content.edges.emplace_back(0, 1, links);

  content.lineage.fill(7);
  content.payload = kEveryPayload;
  content.source_kind = "rtabmap";
  content.source_version = "0.23.8";
  content.options = "orphans=nearest unlinked=odometry max_zone_bytes=0 snap=0.1";
  content.detector = "8";
  for (const packer::PackSummary& pack : packs) content.source_feature_count += pack.features;
  content.source_bytes = content.source_feature_count * 72 + 500;
  write_manifest();
}

void SmallMap::add_zone(const std::string& name, float left,
                        const std::vector<SignatureRecipe>& recipes) {
  packer::PlannedZone zone;
  zone.name = name;
  zone.zone_type = "room";
  zone.label = "Room " + name;
  const double x = left;
  zone.polygon.outer = {{x, 0}, {x + 4, 0}, {x + 4, 4}, {x, 4}};
  plan.zones.push_back(std::move(zone));

  const TemporaryFolder disk;
  packer::PackWriter writer(disk.path(), name);
  std::vector<fb::Node>& nodes = content.nodes.emplace_back();
  for (const SignatureRecipe& recipe : recipes) {
    packer::SignatureRecord record = make_signature(recipe);
    // Noise, which LZ4 cannot compress: a raw chunk.
    if (recipe.image == SignatureRecipe::Image::kPng) record.image = noise(4096);
    const packer::Transform T = record.pose ? *record.pose : *record.odometry_pose;
    nodes.emplace_back(T[3], T[7], T[11], std::atan2(T[4], T[0]), record.id);
    writer.add(record, T[3], T[7]);
  }
  packs.push_back(writer.finish(kEveryPayload));
  folder.files[packs.back().file] = read_bytes(disk / packs.back().file);
}

void SmallMap::write_manifest() {
  content.plan = &plan;
  content.packs = &packs;
  folder.files[std::string(kManifestName)] = packer::manifest_bytes(content);
}

void seal_manifest(packer::Bytes& file) {
  const std::size_t body = file.size() - sizeof(ManifestTail);
  const Digest32 digest = blake2b_32({ByteSpan(file).first(body)});
  std::memcpy(file.data() + body, digest.data(), digest.size());
}

}  // namespace zonepack::test_support
