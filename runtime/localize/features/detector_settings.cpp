// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/features/detector_settings.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace zonepack::localize {
namespace {

// RTAB-Map's Kp/DetectorStrategy, by number.
constexpr std::array<std::string_view, 16> kStrategies = {
    "SURF",       "SIFT",       "ORB",        "FAST/FREAK", "FAST/BRIEF", "GFTT/FREAK",
    "GFTT/BRIEF", "BRISK",      "GFTT/ORB",   "KAZE",       "ORB-OCTREE", "SuperPoint",
    "SURF/FREAK", "GFTT/DAISY", "SURF/DAISY", "PyDetector"};

// The settings of a source by key; the last one counts, as in RTAB-Map.
class Settings {
 public:
  Settings(std::string_view text, std::string place) : text_(text), place_(std::move(place)) {}

  void read(std::string_view key, double& value, double least, double most) {
    const auto text = find(key);
    if (!text) return;
    double parsed = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), parsed);
    if (error != std::errc() || end != text->data() + text->size() ||
        !(parsed >= least && parsed <= most)) {
      note(key, *text);
      return;
    }
    value = parsed;
  }
  void read(std::string_view key, int& value, int least, int most) {
    double number = value;
    read(key, number, least, most);
    if (number != std::floor(number)) {
      note(key, *find(key));
      return;
    }
    value = static_cast<int>(number);
  }
  void read(std::string_view key, bool& value) {
    const auto text = find(key);
    if (!text) return;
    if (*text != "true" && *text != "false" && *text != "1" && *text != "0") {
      note(key, *text);
      return;
    }
    value = *text == "true" || *text == "1";
  }
  const std::string& fault() const { return fault_; }

 private:
  std::optional<std::string_view> find(std::string_view key) const {
    std::optional<std::string_view> found;
    std::string_view rest = text_;
    while (!rest.empty()) {
      const std::string_view item = rest.substr(0, rest.find(';'));
      rest.remove_prefix(std::min(rest.size(), item.size() + 1));
      const std::size_t colon = item.find(':');
      if (colon != std::string_view::npos && item.substr(0, colon) == key) {
        found = item.substr(colon + 1);
      }
    }
    return found;
  }
  void note(std::string_view key, std::string_view value) {
    if (!fault_.empty()) return;
    fault_ = place_ + ": the setting " + std::string(key) + " of its detector is '" +
             std::string(value) + "', which no detector takes; build the map again";
  }

  std::string_view text_;
  std::string place_, fault_;
};

void read_all(Settings& from, DetectorSettings& to) {
  from.read("Kp/MaxFeatures", to.max_features, -1, 100'000);
  from.read("GFTT/QualityLevel", to.quality, 1e-9, 1);
  from.read("GFTT/MinDistance", to.min_distance_px, 0, 1000);
  from.read("GFTT/BlockSize", to.block_px, 1, 31);
  from.read("GFTT/UseHarrisDetector", to.harris);
  from.read("GFTT/K", to.harris_k, 0, 1);
  from.read("ORB/ScaleFactor", to.scale_factor, 1.01, 8);
  from.read("ORB/NLevels", to.levels, 1, 16);
  from.read("ORB/EdgeThreshold", to.edge_px, 0, 200);
  from.read("ORB/FirstLevel", to.first_level, 0, 15);
  from.read("ORB/WTA_K", to.wta_k, 2, 4);
  from.read("ORB/PatchSize", to.patch_px, 2, 200);
  int score = 0;
  from.read("ORB/ScoreType", score, 0, 1);
  to.fast_score = score == 1;
  from.read("FAST/Threshold", to.fast_threshold, 0, 255);
  from.read("SIFT/NOctaveLayers", to.octave_layers, 1, 10);
  from.read("SIFT/ContrastThreshold", to.contrast, 0, 10);
  from.read("SIFT/EdgeThreshold", to.edge_ratio, 1, 1000);
  from.read("SIFT/Sigma", to.sigma, 0.1, 10);
  from.read("BRISK/Thresh", to.brisk_threshold, 1, 255);
  from.read("BRISK/Octaves", to.brisk_octaves, 0, 10);
  from.read("BRISK/PatternScale", to.brisk_scale, 0.1, 10);
  if (to.max_features <= 0) to.max_features = 2000;  // RTAB-Map: 0 and less mean no limit
}

}  // namespace

const char* to_string(Detector detector) noexcept {
  switch (detector) {
    case Detector::kGfttOrb:
      return "GFTT/ORB";
    case Detector::kOrb:
      return "ORB";
    case Detector::kSift:
      return "SIFT";
    case Detector::kBrisk:
      return "BRISK";
  }
  return "?";
}

std::uint32_t DetectorSettings::descriptor_bytes() const noexcept {
  switch (detector) {
    case Detector::kSift:
      return 128 * sizeof(float);
    case Detector::kBrisk:
      return 64;
    default:
      return 32;
  }
}

Outcome<DetectorSettings> parse_detector(std::string_view provenance, const std::string& map) {
  const std::size_t blank = provenance.find(' ');
  const std::string_view name = provenance.substr(0, blank);
  const std::string place = map.empty() ? std::string("the map") : map;
  static constexpr const char* kKnown = "zoneloc knows GFTT/ORB, ORB, SIFT and BRISK";
  if (name.empty()) {
    return failure(place +
                   ": its manifest does not say which detector found its features; a map "
                   "without features, such as a point cloud's, is none to localize a camera "
                   "in; that of a database is built again from it");
  }
  unsigned number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || number >= kStrategies.size()) {
    return failure(place + ": its features are from the detector '" + std::string(name) + "'; " +
                   kKnown);
  }
  DetectorSettings settings;
  switch (number) {
    case 1:
      settings.detector = Detector::kSift;
      break;
    case 2:
      settings.detector = Detector::kOrb;
      break;
    case 7:
      settings.detector = Detector::kBrisk;
      break;
    case 8:
      settings.detector = Detector::kGfttOrb;
      break;
    default:
      return failure(place + ": its features are from the detector " +
                     std::string(kStrategies[number]) +
                     ", which OpenCV's features2d does not have; " + kKnown +
                     ": map again with Kp/DetectorStrategy 8, 2, 1 or 7");
  }
  if (blank == std::string_view::npos) return settings;
  Settings from(provenance.substr(blank + 1), place);
  read_all(from, settings);
  if (!from.fault().empty()) return failure(from.fault());
  return settings;
}

}  // namespace zonepack::localize
