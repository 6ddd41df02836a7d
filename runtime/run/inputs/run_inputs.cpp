// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/run_inputs.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "platform/base/shell_word.hpp"
#include "platform/devices/board.hpp"
#include "platform/files/storage.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack {
namespace {

Failure map_failure(const std::string& folder, const Failure& why,
                    std::optional<ByteCount> budget) {
  const std::string manifest = folder + "/" + std::string(kManifestName);
  const std::string verify = "zonepack verify " + shell_word(folder);
  switch (why.code) {
    case ErrorCode::kNoRoom:
      return {why.code,
              manifest + ": " + why.message + ": " + format_byte_count(kFreeMapBytes) +
                  " and the " +
                  (budget ? "budget of " + format_byte_count(*budget)
                          : "default limit of " + format_byte_count(default_budget_limit()) +
                                ", a quarter of this computer's memory") +
                  "; whether it is as zonepack build writes it is said by: " + verify};
    case ErrorCode::kNotFound:
      return {why.code, manifest +
                            ": no such file; expected the folder of a map, which zonepack build "
                            "writes: zonepack build --help"};
    case ErrorCode::kIo:
      return {why.code, manifest + ": cannot be read: " + why.message +
                            "; expected the folder of a map, which zonepack build writes"};
    default:
      return {why.code, manifest + ": " + why.message +
                            "; build the map again with zonepack build, or copy it again; what is "
                            "wrong with it: " +
                            verify};
  }
}

}  // namespace

Outcome<RunInputs> read_run_inputs(const RunChoices& choices) {
  if (choices.start.kind == StartChoice::Kind::kTruth && choices.truth.empty()) {
    return usage_failure("--start truth needs --truth FILE");
  }
  RunInputs inputs;
  auto loaded = load_usable_settings(choices.config);
  if (!loaded) return loaded.error();
  inputs.warnings = std::move(loaded->warnings);
  inputs.settings = std::move(loaded->settings);
  inputs.settings_text = std::move(loaded->text);
  const std::string folder = choices.map.empty() ? inputs.settings.map.path : choices.map;
  if (folder.empty()) {
    return failure("no map: give --map DIR or map.path in " + choices.config);
  }
  const std::optional<ByteCount> budget =
      choices.budget ? choices.budget : inputs.settings.memory.budget;
  auto catalog = Catalog::open(folder, inputs.settings.memory.payload.mask,
                               budget.value_or(default_budget_limit()) + kFreeMapBytes);
  if (!catalog) return map_failure(folder, catalog.error(), budget);
  if (auto chosen = catalog->choose_layers(inputs.settings.memory.layers); !chosen) {
    return chosen.error();
  }
  inputs.catalog = std::move(catalog).value();
  if (!inputs.settings.preload.transitions.empty()) {
    auto learned = load_transitions(inputs.settings.preload.transitions);
    if (!learned)
      return Failure{learned.error().code, "preload.transitions: " + learned.error().message};
    inputs.learned = std::make_shared<LearnedTransitions>(std::move(*learned));
  }

  if (!choices.truth.empty()) {
    auto truth = read_truth(choices.truth);
    if (!truth) return truth.error();
    inputs.truth = std::move(*truth);
  }
  if (!choices.corrections.empty()) {
    auto corrections = read_corrections(choices.corrections);
    if (!corrections) return corrections.error();
    inputs.corrections = std::move(*corrections);
    const std::vector<CatalogZone>& zones = inputs.catalog.zones;
    // A pipe is read once, and was: fixes alone come through one.
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(choices.corrections, ignored)) return inputs;
    auto commands = read_command_lines(choices.corrections, [&](std::string_view name) {
      const auto zone = std::ranges::find(zones, name, &CatalogZone::name);
      return zone == zones.end() ? kNoZone : static_cast<ZoneId>(zone - zones.begin());
    });
    if (!commands) return commands.error();
    inputs.commands = std::move(*commands);
  }
  return inputs;
}

ByteCount default_budget_limit() {
  static const ByteCount limit = machine_memory_bytes() / 4;
  return limit;
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

bool has_habits(const Settings& settings) {
  return uses_habits(settings.preload) || settings.memory.eviction == EvictionRule::kExpected;
}

Outcome<LearnedTransitions> load_transitions(const std::string& path) {
  const auto file = read_file(path, kMostTransitionsBytes);
  if (!file) {
    const bool large = file.error().code == ErrorCode::kTooLarge;
    return failure(path + ": " +
                       (large ? "is over " + format_byte_count(kMostTransitionsBytes)
                              : reason_text(file.error())) +
                       "; expected a file of transitions, as zoned learn writes it",
                   file.error().code);
  }
  auto learned = read_transitions(*file);
  if (!learned) return failure(path + ": " + learned.error().message, learned.error().code);
  return std::move(learned).value();
}

MapTerms map_terms(const RunChoices& choices, const Settings& settings,
                   std::shared_ptr<const LearnedTransitions> learned) {
  MapTerms terms;
  terms.budget = choices.budget ? choices.budget : settings.memory.budget;
  terms.default_most = default_budget_limit();
  terms.max_signatures = choices.max_signatures.value_or(settings.memory.max_signatures);
  terms.pinned = settings.memory.pinned;
  terms.rates.storage = choices.storage_rate.value_or(
      static_cast<std::uint64_t>(settings.loading.expected_storage_rate()));
  terms.rates.decode = static_cast<std::uint64_t>(settings.loading.decode_rate);
  terms.period_ns = static_cast<std::int64_t>(1e9 / settings.cycle.period_hz + 0.5);
  terms.habits = has_habits(settings);
  terms.learned = std::move(learned);
  terms.eviction = settings.memory.eviction;
  return terms;
}

}  // namespace zonepack
