// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/input_seeds.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
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

// A map of two keyframes of stella_vslam, as of 2026 or of 2019.
Bytes stella_map(bool of_2019) {
  nlohmann::json keyframes, landmarks;
  for (int id : {1, 2}) {
    nlohmann::json one = {{"ts", 0.5 + id},
                          {"cam", "front"},
                          {"rot_cw", {0.0, 0.0, 0.0, 1.0}},
                          {"trans_cw", {0.25 * id, 0.0, 1.0 * id}},
                          {"n_keypts", 2},
                          {"x_rights", nlohmann::json::array()},
                          {"depths", nlohmann::json::array()},
                          {"span_parent", id == 1 ? 4294967295U : 1U},
                          {"span_children", nlohmann::json::array()},
                          {"loop_edges", {3 - id}},
                          {"lm_ids", {7, -1}}};
    nlohmann::json points = nlohmann::json::array(), bare = points, words = points;
    for (int k : {0, 1}) {
      points.push_back({{"pt", {10.5 + k, 20.25}}, {"ang", 90.0 * k}, {"oct", k}});
      bare.push_back({10.5 + k, 20.25});
      nlohmann::json descriptor;
      for (unsigned word = 0; word < 8; ++word) descriptor.push_back(0x01020304U * word);
      words.push_back(descriptor);
    }
    one["descs"] = words;
    if (of_2019) {
      one["keypts"] = points;
      one["undists"] = bare;
      one["scale_factor"] = 1.2;
    } else {
      one["undist_keypts"] = points;
      one["orb_params"] = "orb";
    }
    keyframes[std::to_string(id)] = one;
  }
  landmarks["7"] = {{"pos_w", {0.5, 0.25, 3.0}}, {"ref_keyfrm", 1}};
  nlohmann::json map = {{"cameras",
                         {{"front",
                           {{"setup_type", "RGBD"},
                            {"model_type", "Perspective"},
                            {"cols", 640},
                            {"rows", 480},
                            {"fx", 500.0},
                            {"fy", 500.0},
                            {"cx", 320.0},
                            {"cy", 240.0},
                            {"k1", 0.125}}}}},
                        {"keyframes", keyframes},
                        {"landmarks", landmarks}};
  if (!of_2019) map["orb_params"] = {{"orb", {{"scale_factor", 1.2}, {"num_levels", 8}}}};
  const std::vector<std::uint8_t> packed = nlohmann::json::to_msgpack(map);
  return bytes_of({reinterpret_cast<const char*>(packed.data()), packed.size()});
}

void add_u32(std::string& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 255U);
}

constexpr std::uint32_t kPoints = 40;

std::uint32_t word_of(float value) { return std::bit_cast<std::uint32_t>(value); }

std::string pcd_header(const char* data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity rgb\nSIZE 4 4 4 4 4\nTYPE F F F F U\n"
         "COUNT 1 1 1 1 1\nWIDTH 40\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 40\nDATA " +
         std::string(data) + "\n";
}

// Points along a wall, over three tiles of 10 m.
std::vector<Bytes> clouds() {
  std::string text = pcd_header("ascii"), rows = pcd_header("binary");
  std::array<std::string, 5> columns;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const std::array<std::uint32_t, 5> point = {word_of(0.5F * static_cast<float>(i)), word_of(-2),
                                                word_of(0.25F), word_of(80), 0x102030};
    for (std::size_t k = 0; k < point.size(); ++k) {
      add_u32(rows, point[k]);
      add_u32(columns[k], point[k]);
    }
    text += std::to_string(i / 2) + (i % 2 == 0 ? ".0" : ".5") + " -2 0.25 80 1056816\n";
  }
  // LZF: literal runs of 32 bytes for the first column; of every other one its first word, and
  // matches of 4 bytes back for the 156 behind it (length: 7 in the first byte, then 156 - 9).
  std::string packed;
  for (std::size_t at = 0; at < columns[0].size(); at += 32)
    packed += '\x1F' + columns[0].substr(at, 32);
  for (std::size_t k = 1; k < columns.size(); ++k) {
    packed += '\x03' + columns[k].substr(0, 4);
    packed += {'\xE0', static_cast<char>(columns[k].size() - 4 - 9), '\x03'};
  }
  std::string compressed = pcd_header("binary_compressed");
  add_u32(compressed, static_cast<std::uint32_t>(packed.size()));
  add_u32(compressed, kPoints * 20);
  return {bytes_of(text), bytes_of(rows), bytes_of(compressed + packed)};
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
  seeds.msgpack = {stella_map(false), stella_map(true)};
  seeds.pcd = clouds();
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
