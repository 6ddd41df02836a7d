// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/rtabmap_fixture.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

// The program zonepack as scripts use it, in a folder of its own.
namespace zonepack::system_test {

struct Outcome {
  int exit_code = 0;  // 128 + number when a signal ended it
  std::string output;
};

inline Outcome run(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error(command + ": cannot be run");
  Outcome outcome;
  std::array<char, 65536> piece;
  for (std::size_t n; (n = std::fread(piece.data(), 1, piece.size(), pipe)) > 0;) {
    outcome.output.append(piece.data(), n);
  }
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

inline std::string bytes_of_file(const std::filesystem::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

// Two rooms side by side, y -5 to 5: "east" x 12.5 to 25.5, "west" x `west` to 12.5.
inline std::string two_rooms(double west = 0.5) {
  const auto room = [](const std::string& name, double x0, double x1) {
    const auto point = [](double x, double y) {
      return "[" + std::to_string(x) + "," + std::to_string(y) + "]";
    };
    return R"({"type":"Feature","properties":{"name":")" + name +
           R"(","zone_type":"room"},"geometry":{"type":"Polygon","coordinates":[[)" +
           point(x0, -5) + "," + point(x1, -5) + "," + point(x1, 5) + "," + point(x0, 5) + "," +
           point(x0, -5) + "]]}}";
  };
  return R"({"type":"FeatureCollection","features":[)" + room("east", 12.5, 25.5) + "," +
         room("west", west, 12.5) + "]}";
}

class Packer {
 public:
  Packer() { write("zones.geojson", two_rooms()); }

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }

  void write_database(const test_support::RtabmapFixture& fixture) const {
    test_support::write_rtabmap_database(path("map.db"), fixture);
  }

  // Runs zonepack in the folder; the output includes standard error.
  Outcome zonepack(const std::string& arguments) const {
    return run("cd " + folder_.path().string() + " && " ZONEPACK_PROGRAM " " + arguments + " 2>&1");
  }

  Outcome build(const std::string& more = "") const {
    return zonepack("build --db map.db --zones zones.geojson --out map " + more);
  }

  // The JSON of a build that must succeed.
  nlohmann::json build_summary(const std::string& more = "") const {
    const Outcome outcome = build("--json summary.json " + more);
    if (outcome.exit_code != 0) throw std::runtime_error(outcome.output);
    return nlohmann::json::parse(bytes_of_file(path("summary.json")));
  }

  // What the packs hold, by id.
  std::map<std::int64_t, nlohmann::json> exported() const {
    const Outcome outcome = zonepack("export map --jsonl");
    if (outcome.exit_code != 0) throw std::runtime_error(outcome.output);
    std::map<std::int64_t, nlohmann::json> signatures;
    std::istringstream lines(outcome.output);
    for (std::string line; std::getline(lines, line);) {
      auto json = nlohmann::json::parse(line);
      const std::int64_t id = json.at("id");
      signatures[id] = std::move(json);
    }
    return signatures;
  }

 private:
  test_support::TemporaryFolder folder_;
};

// Signatures 1 to 4 at x 1 to 4, with a few features each.
inline test_support::RtabmapFixture four_signatures() {
  test_support::RtabmapFixture fixture;
  for (std::int32_t id = 1; id <= 4; ++id) {
    test_support::SignatureRecipe recipe;
    recipe.id = id;
    recipe.x = static_cast<float>(id);
    fixture.signatures.push_back(test_support::make_signature(recipe));
  }
  return fixture;
}

}  // namespace zonepack::system_test
