// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/settings.hpp"

#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "runtime/odometry/det_math.hpp"
#include "runtime/settings/field.hpp"
#include "runtime/settings/yaml_section.hpp"

namespace zonepack {
namespace {

constexpr std::size_t kLargestFile = 1 << 20;

template <typename Section>
void read_section(YamlSection& file, const char* name, const Fields<Section>& fields, Section& into,
                  FaultList& faults) {
  YamlSection section(file.take(name), name, faults);
  section.read(fields, into);
  section.finish();
}

void read_signal_entry(const std::string& name, const YAML::Node& node, FaultList& faults,
                       std::map<std::string, CanSignal>& signals) {
  const std::size_t faults_before = faults.size();
  YamlSection section(node, "can.signals." + name, faults);
  SignalText text;
  section.read(signal_fields(), text);
  CanSignal signal;
  signal.id = text.id;
  signal.extended = text.extended;
  signal.bits = {static_cast<std::uint16_t>(text.start), static_cast<std::uint16_t>(text.length),
                 text.byte_order};
  signal.type = text.type;
  signal.factor = text.factor;
  signal.offset = text.offset;
  if (const YAML::Node multiplexer = section.take("multiplexer"); multiplexer.IsDefined()) {
    YamlSection inner(multiplexer, section.path_of("multiplexer"), faults);
    MultiplexText mux;
    inner.read(multiplex_fields(), mux);
    inner.finish();
    signal.multiplex =
        CanSignal::Multiplex{{static_cast<std::uint16_t>(mux.start),
                              static_cast<std::uint16_t>(mux.length), mux.byte_order},
                             mux.value};
  }
  section.finish();
  if (faults.size() == faults_before && !is_valid(signal)) {
    faults.add(
        section.mark(), "can.signals." + name,
        "no such signal fits a frame; needed: id (up to 0x7FF, with extended: true up to "
        "0x1FFFFFFF), length 1 to 64 (float 32, double 64) within 64 bytes from start, factor "
        "other than 0");
  }
  signals.emplace(name, signal);
}

void read_can(YamlSection& file, CanSettings& can, FaultList& faults) {
  YamlSection section(file.take("can"), "can", faults);
  section.read(can_fields(), can);
  const YamlSection signals(section.take("signals"), "can.signals", faults);
  for (const auto& [name, node] : signals.entries()) {
    read_signal_entry(name, node, faults, can.signals);
  }
  section.finish();
}

// The signal that a key of the section odometry names.
void resolve(const YamlSection& section, const char* key, const std::string& name,
             const CanSettings& can, FaultList& faults, CanSignal& signal) {
  const auto found = can.signals.find(name);
  if (found != can.signals.end()) {
    signal = found->second;
    return;
  }
  std::string known;
  for (const auto& [word, unused] : can.signals) known += (known.empty() ? "" : ", ") + word;
  faults.add(section.mark(), section.path_of(key),
             (name.empty() ? std::string("missing; this model needs it")
                           : "no signal \"" + name + "\" in can.signals") +
                 "; known signals: " + (known.empty() ? "none" : known));
}

void read_odometry(YamlSection& file, OdometrySettings& odometry, const CanSettings& can,
                   FaultList& faults) {
  YamlSection section(file.take("odometry"), "odometry", faults);
  section.read(odometry_fields(), odometry);
  section.read(wheel_fields(), odometry.wheels);
  section.finish();
  const bool twist = odometry.wheels.model == OdometryModel::kTwist;
  resolve(section, twist ? "forward" : "left", twist ? odometry.forward : odometry.left, can,
          faults, odometry.wheels.left);
  resolve(section, twist ? "yaw_rate" : "right", twist ? odometry.yaw_rate : odometry.right, can,
          faults, odometry.wheels.right);
  double metres = odometry.scale;
  if (odometry.unit != WheelUnit::kMetres) metres *= odometry.wheel_radius_m;
  if (odometry.unit == WheelUnit::kTurns) metres *= 2 * kPi;
  odometry.wheels.metres_per_unit = metres;
}

void check_together(const Settings& settings, FaultList& faults) {
  const YAML::Mark nowhere = YAML::Mark::null_mark();
  if (settings.zones.least_depth_m > settings.zones.most_depth_m) {
    faults.add(nowhere, "zones.least_depth", "must not be over zones.most_depth");
  }
  if (settings.pose.history_s / settings.pose.history_step_s > 10'000) {
    faults.add(nowhere, "pose.history", "must not be over 10000 times pose.history_step");
  }
  if (settings.odometry.wheels.timeout_s < 2 / settings.cycle.period_hz) {
    faults.add(nowhere, "odometry.timeout", "must be at least two cycles (cycle.period_hz)");
  }
}

void read_file(const YAML::Node& root, const std::string& path, Settings& settings,
               FaultList& faults) {
  YamlSection file(root, "", faults);
  read_section(file, "map", map_fields(), settings.map, faults);
  read_section(file, "memory", memory_fields(), settings.memory, faults);
  read_section(file, "loading", loading_fields(), settings.loading, faults);
  read_can(file, settings.can, faults);
  read_odometry(file, settings.odometry, settings.can, faults);
  read_section(file, "pose", pose_fields(), settings.pose, faults);
  read_section(file, "zones", zones_fields(), settings.zones, faults);
  read_section(file, "preload", preload_fields(), settings.preload, faults);
  read_section(file, "cycle", cycle_fields(), settings.cycle, faults);
  file.finish();
  check_together(settings, faults);
  if (std::string& map = settings.map.path; !map.empty()) {
    map = (std::filesystem::path(path).parent_path() / map).lexically_normal().string();
  }
}

}  // namespace

LoadedSettings parse_settings(const std::string& text, const std::string& path) {
  LoadedSettings loaded;
  FaultList faults(path);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      faults.add(documents[1].Mark(), "", "a second document; expected one (remove the ---)");
    }
    read_file(documents.empty() ? YAML::Node() : documents[0], path, loaded.settings, faults);
  } catch (const YAML::Exception& error) {
    faults.add(error.mark, "", "not YAML: " + error.msg);
  }
  loaded.faults = faults.take();
  return loaded;
}

LoadedSettings load_settings(const std::string& path) {
  LoadedSettings failed;
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || !text || text.str().empty()) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "empty or not a file";
    failed.faults = {path + ": cannot be read: " + reason + "; expected a settings file (YAML)"};
    return failed;
  }
  if (text.str().size() > kLargestFile) {
    failed.faults = {path + ": over 1 MiB; expected a settings file (YAML)"};
    return failed;
  }
  return parse_settings(text.str(), path);
}

}  // namespace zonepack
