// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/input_seeds.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "runtime/protocol/messages.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/recording/cycle_block.hpp"
#include "runtime/recording/preface.hpp"
#include "runtime/recording/recording_end.hpp"
#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::fuzz {
namespace {

using packer::Bytes;

Bytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Bytes contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return bytes_of(text);
}

constexpr const char* kRooms = R"({"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"name":"hall","zone_type":"corridor","z_min":0,"z_max":3},
 "geometry":{"type":"Polygon","coordinates":[[[0,0],[10,0],[10,4],[0,4],[0,0]],
  [[1,1],[1,2],[2,2],[2,1],[1,1]]]}},
{"type":"Feature","properties":{"name":"left","zone_type":"room"},
 "geometry":{"type":"Polygon","coordinates":[[[0,4],[5,4],[5,8],[0,8],[0,4]]]}},
{"type":"Feature","id":7,"properties":{"portal":true,"zones":["hall","left"]},
 "geometry":{"type":"LineString","coordinates":[[2,4],[3,4]]}}]})";

Bytes database() {
  const test_support::TemporaryFolder folder;
  test_support::RtabmapFixture fixture;
  for (std::int32_t id = 1; id <= 3; ++id) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.x = static_cast<float>(id);
    recipe.features = 5;
    recipe.user_data = recipe.global_descriptor = recipe.sensors = true;
    recipe.neighbours = {id % 3 + 1};
    fixture.signatures.push_back(test_support::make_signature(recipe));
  }
  test_support::write_rtabmap_database(folder / "map.db", fixture);
  return contents(folder / "map.db");
}

void add_block(Bytes& out, BlockKind kind, ByteSpan content) {
  const auto size = static_cast<std::uint32_t>(content.size());
  out.push_back(static_cast<std::byte>(kind));
  const auto bytes = std::as_bytes(std::span(&size, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
  out.insert(out.end(), content.begin(), content.end());
}

Bytes recording() {
  RecordingPreface preface;
  preface.program = "fuzz";
  preface.settings_path = "agilex.yaml";
  preface.settings = "map: {path: map}\n";
  preface.map_folder = "map";
  preface.manifest = {std::byte{1}};
  preface.terms.period_ns = 10'000'000;
  Bytes out, content;
  write_preface(preface, [&](ByteSpan block) {
    if (!open_block(block, content)) return;
    add_block(out, BlockKind::kPreface, content);
  });
  CycleBlockWriter block(preface.terms.period_ns);
  TappedCycle cycle;
  for (cycle.head.cycle = 0; cycle.head.cycle < 20; ++cycle.head.cycle) {
    cycle.head.now_ns = static_cast<std::int64_t>(cycle.head.cycle) * preface.terms.period_ns;
    block.add(cycle);
  }
  add_block(out, BlockKind::kCycles, block.content());
  RecordingEnd end;
  end.cycles = 20;
  add_block(out, BlockKind::kEnd, write_end(end));
  return out;
}

void add_messages(std::vector<Bytes>& out) {
  const auto add = [&out](std::byte way, ByteSpan message) {
    Bytes& bytes = out.emplace_back(1, way);
    bytes.insert(bytes.end(), message.begin(), message.end());
  };
  constexpr std::byte kRequest{0}, kReply{1};
  {
    MessageBuilder m;
    const auto name = m.builder().CreateString("client");
    add(kRequest, m.request(1, wire::CreateHello(m.builder(), kProtocolVersion, name)));
  }
  {
    MessageBuilder m;
    const std::vector<std::uint32_t> zones{1, 2, 3};
    const auto list = m.builder().CreateVector(zones);
    add(kRequest, m.request(2, wire::CreateRouteHint(m.builder(), list), 9));
  }
  {
    MessageBuilder m;
    const wire::Pose pose(1, 2, 3);
    const wire::Covariance covariance(1, 0, 0, 1, 0, 1);
    add(kRequest, m.request(3, wire::CreateGivePose(m.builder(), wire::Clock::Realtime, 5, &pose,
                                                    &covariance)));
  }
  MessageBuilder done;
  add(kReply, done.reply(4, wire::CreateDone(done.builder())));
  MessageBuilder fault;
  add(kReply, fault.fault(5, wire::Fault::NoRoom, "no room"));
}

InputSeeds make_input_seeds() {
  InputSeeds seeds;
  seeds.geojson = {bytes_of(kRooms)};
  seeds.settings = {contents(ZONEPACK_SOURCE_DIR "/config/agilex.yaml")};
  seeds.sqlite = {database()};
  seeds.recordings = {recording()};
  add_messages(seeds.messages);
  return seeds;
}

}  // namespace

const InputSeeds& input_seeds() {
  static const InputSeeds all = make_input_seeds();
  return all;
}

std::vector<Bytes> corpus(const std::string& kind) {
  std::vector<std::filesystem::path> paths;
  const std::filesystem::path folder = ZONEPACK_SOURCE_DIR "/tests/fuzz/corpus/" + kind;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> inputs;
  for (const auto& path : paths) inputs.push_back(contents(path));
  return inputs;
}

}  // namespace zonepack::fuzz
