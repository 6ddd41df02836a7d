// SPDX-License-Identifier: Apache-2.0
// Packs a database with the program itself, exports what the packs hold, and compares every field
// of every signature with the database, bit for bit.
//
//   round_trip_check ZONEPACK DB ZONES.geojson PAYLOAD
//
// DB may be $NAME: taken from the environment; exit code 77 (not run) when that is not set.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>

#include "tests/support/temporary_folder.hpp"
#include "tests/system/round_trip/expected_signature.hpp"

namespace zonepack::round_trip {
namespace {

constexpr int kNotRun = 77;

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

// Zones as a reader of the GeoJSON alone sees them: outer rings, by the crossing rule.
class Plan {
 public:
  explicit Plan(const std::string& path) {
    std::ifstream file(path);
    const nlohmann::json drawing = nlohmann::json::parse(file);
    for (const auto& feature : drawing["features"]) {
      if (feature["geometry"]["type"] != "Polygon") continue;
      zones_.push_back({feature["properties"]["name"], feature["geometry"]["coordinates"][0]});
    }
  }

  // The zones that hold the point, or whose border is within a centimetre.
  std::set<std::string> zones_at(double x, double y) const {
    std::set<std::string> names;
    for (const auto& [name, ring] : zones_) {
      bool inside = false, near = false;
      for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        const double ax = ring[i][0], ay = ring[i][1], bx = ring[i + 1][0], by = ring[i + 1][1];
        if ((ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)) inside = !inside;
        const double length2 = (bx - ax) * (bx - ax) + (by - ay) * (by - ay);
        const double t = length2 == 0 ? 0 : ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length2;
        const double s = std::min(1.0, std::max(0.0, t));
        near = near || std::hypot(x - ax - s * (bx - ax), y - ay - s * (by - ay)) < 0.01;
      }
      if (inside || near) names.insert(name);
    }
    return names;
  }

 private:
  std::vector<std::pair<std::string, nlohmann::json>> zones_;
};

struct Pipe {
  explicit Pipe(const std::string& command) : stream(popen(command.c_str(), "r")) {
    if (stream == nullptr) throw std::runtime_error(command + ": cannot be run");
  }
  ~Pipe() { pclose(stream); }
  bool next_line(std::string& line) {
    char* text = nullptr;
    std::size_t room = 0;
    const ssize_t size = getline(&text, &room, stream);
    if (size > 0) line.assign(text, static_cast<std::size_t>(size));
    std::free(text);
    return size > 0;
  }
  FILE* stream;
};

int check(const std::string& zonepack, const std::string& database, const std::string& zones,
          const std::string& payload) {
  const test_support::TemporaryFolder folder;
  const std::string map = (folder / "map").string();
  const std::string build = zonepack + " build --db " + database + " --zones " + zones + " --out " +
                            map + " --payload " + payload;
  if (std::system(build.c_str()) != 0) {
    std::cerr << build << ": failed\n";
    return 1;
  }
  const ExpectedSignatures expected(database);
  const Plan plan(zones);
  const std::vector<std::string> kinds = split(payload);
  std::set<std::int64_t> seen;
  std::pair<std::string, std::int64_t> last{"", -1};
  int faults = 0;
  const auto fault = [&](const std::string& text) {
    if (++faults <= 20) std::cerr << text << "\n";
  };
  Pipe pipe(zonepack + " export " + map + " --jsonl");
  for (std::string line; pipe.next_line(line);) {
    const auto found = nlohmann::json::parse(line);
    const std::int64_t id = found.at("id");
    const std::string name = "signature " + std::to_string(id);
    if (!seen.insert(id).second) fault(name + " was exported twice");
    const std::pair<std::string, std::int64_t> place{found.at("zone"), id};
    if (place <= last) fault(name + " is not in the order of zone, then id");
    last = place;
    const std::string difference = first_difference(expected.signature(id, kinds), found);
    if (!difference.empty()) fault(name + " " + difference);
    if (found["pose"].is_null()) continue;
    const auto possible = plan.zones_at(found["pose"][3], found["pose"][7]);
    if (!possible.empty() && !possible.contains(place.first)) {
      fault(name + " was put in zone " + place.first + ", but stands in " + *possible.begin());
    }
  }
  for (const std::int64_t id : expected.ids()) {
    if (!seen.contains(id)) fault("signature " + std::to_string(id) + " was not exported");
  }
  std::cout << database << " with " << payload << ": " << seen.size() << " of "
            << expected.ids().size() << " signatures compared, " << faults << " faults\n";
  return faults == 0 && !seen.empty() ? 0 : 1;
}

}  // namespace
}  // namespace zonepack::round_trip

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: round_trip_check ZONEPACK DB ZONES.geojson PAYLOAD\n";
    return 2;
  }
  std::string database = argv[2];
  if (database.starts_with('$')) {
    const char* const value = std::getenv(database.c_str() + 1);
    if (value == nullptr || *value == '\0') {
      std::cout << "not run: set " << database.substr(1) << " to the path of the database\n";
      return zonepack::round_trip::kNotRun;
    }
    database = value;
  }
  try {
    return zonepack::round_trip::check(argv[1], database, argv[3], argv[4]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
