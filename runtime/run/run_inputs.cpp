// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/run_inputs.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

constexpr double kNear_s = 1.0;

bool read_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

std::string map_fault(const std::string& folder, const Error& error) {
  return folder + ": cannot be opened as a map: " + to_string(error.code) + " (" +
         std::to_string(error.detail) +
         "); it must hold manifest.zpm as written by zonepack build, and zonepack verify tells "
         "more";
}

}  // namespace

std::optional<StartChoice> parse_start(const std::string& text) {
  if (text == "fix") return StartChoice{StartChoice::Kind::kFix, {}};
  if (text == "truth") return StartChoice{StartChoice::Kind::kTruth, {}};
  std::array<double, 3> numbers{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::size_t comma = rest.find(',');
    const bool last = i + 1 == numbers.size();
    if (last != (comma == std::string_view::npos)) return std::nullopt;
    if (!read_number(rest.substr(0, comma), numbers[i])) return std::nullopt;
    if (!last) rest.remove_prefix(comma + 1);
  }
  const double yaw_rad = numbers[2] * (kPi / 180);
  if (std::abs(yaw_rad) > kLargestAngle_rad) return std::nullopt;
  return StartChoice{StartChoice::Kind::kPose, {numbers[0], numbers[1], wrap_angle(yaw_rad)}};
}

std::optional<std::string> read_run_inputs(const RunChoices& choices, RunInputs& inputs) {
  LoadedSettings loaded = load_settings(choices.config);
  if (!loaded.ok()) {
    std::string all = "settings cannot be used";
    for (const std::string& fault : loaded.faults) all += "\n  " + fault;
    return all;
  }
  inputs.settings = std::move(loaded.settings);
  inputs.settings_text = std::move(loaded.text);
  const std::string folder = choices.map.empty() ? inputs.settings.map.path : choices.map;
  if (folder.empty()) return "no map: give --map DIR or map.path in " + choices.config;
  Result<Catalog> catalog = Catalog::open(folder, inputs.settings.memory.payload.mask);
  if (!catalog) return map_fault(folder, catalog.error());
  inputs.catalog = std::move(catalog).value();

  std::string fault;
  if (!choices.corrections.empty()) {
    auto corrections = read_corrections(choices.corrections, fault);
    if (!corrections) return fault;
    inputs.corrections = std::move(*corrections);
  }
  if (!choices.truth.empty()) {
    inputs.truth = read_truth(choices.truth, fault);
    if (!inputs.truth) return fault;
  }
  return std::nullopt;
}

CycleConfig cycle_config(const Settings& settings) {
  CycleConfig config;
  config.odometry = settings.odometry.wheels;
  config.filter = settings.pose;
  config.tracker = settings.zones;
  config.preload = settings.preload;
  if (const auto& dock = settings.gpio.dock) {
    const DockPlace& at = dock->place;
    config.dock =
        CycleConfig::Dock{{at.x_m, at.y_m, wrap_angle(at.yaw_rad)}, at.sigma_m, at.sigma_rad};
  }
  for (const GpioSettings::Marker& marker : settings.gpio.markers) {
    const std::vector<std::string>& zones = marker.place.zones;
    config.markers.push_back(
        {marker.name, zones.front(), zones.size() > 1 ? zones[1] : "", marker.place.reach_m});
  }
  return config;
}

MapTerms map_terms(const RunChoices& choices, const Settings& settings) {
  MapTerms terms;
  terms.budget = choices.budget ? choices.budget : settings.memory.budget;
  terms.max_signatures = choices.max_signatures.value_or(settings.memory.max_signatures);
  terms.pinned = settings.memory.pinned;
  terms.rates.storage = choices.storage_rate.value_or(
      static_cast<std::uint64_t>(settings.loading.expected_storage_rate()));
  terms.rates.decode = static_cast<std::uint64_t>(settings.loading.decode_rate);
  terms.period_ns = static_cast<std::int64_t>(1e9 / settings.cycle.period_hz + 0.5);
  return terms;
}

std::optional<Pose2> first_truth(const TruthTrack* truth, std::int64_t start_ns) {
  if (truth == nullptr) return std::nullopt;
  if (const auto pose = truth->at(start_ns)) return pose;
  const TruthTrack::Sample& first = truth->samples().front();
  const bool near =
      first.t_ns > start_ns && static_cast<double>(first.t_ns - start_ns) < kNear_s * 1e9;
  return near ? std::optional(first.T_map_base) : std::nullopt;
}

}  // namespace zonepack
