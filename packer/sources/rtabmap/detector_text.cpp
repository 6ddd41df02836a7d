// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/detector_text.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

namespace zonepack::packer {
namespace {

// Of each number of RTAB-Map's Kp/DetectorStrategy that OpenCV's features2d can repeat: the keys
// that its settings begin with.
std::vector<std::string_view> families(std::string_view strategy) {
  if (strategy == "1") return {"SIFT/"};
  if (strategy == "2") return {"ORB/", "FAST/Threshold"};
  if (strategy == "7") return {"BRISK/"};
  if (strategy == "8") return {"GFTT/", "ORB/"};
  return {};
}

}  // namespace

std::string detector_text(const MapOutline& outline) {
  const std::optional<std::string> strategy = outline.parameter("Kp/DetectorStrategy");
  if (!strategy) return "";
  std::string settings;
  const auto prefixes = families(*strategy);
  std::string_view rest = outline.parameters;
  while (!rest.empty()) {
    const std::string_view entry = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
    const std::string_view key = entry.substr(0, entry.find(':'));
    if (key.ends_with("/Gpu")) continue;
    const bool wanted = std::any_of(prefixes.begin(), prefixes.end(), [&](std::string_view prefix) {
      return key.starts_with(prefix);
    });
    if (wanted) settings.append(";").append(entry);
  }
  if (settings.empty()) return *strategy;
  const std::string most = outline.parameter("Kp/MaxFeatures").value_or("500");
  return *strategy + " Kp/MaxFeatures:" + most + settings;
}

}  // namespace zonepack::packer
