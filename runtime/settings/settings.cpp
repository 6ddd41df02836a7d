// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/settings.hpp"

#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "platform/base/file_kind.hpp"
#include "runtime/settings/field.hpp"
#include "runtime/settings/gpio_section.hpp"
#include "runtime/settings/odometry_section.hpp"
#include "runtime/settings/yaml_limits.hpp"
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

void check_together(const Settings& settings, FaultList& faults) {
  const YAML::Mark nowhere = YAML::Mark::null_mark();
  if (settings.zones.least_depth_m > settings.zones.most_depth_m) {
    faults.add(nowhere, "zones.least_depth", "must not be over zones.most_depth");
  }
  if (settings.pose.history_s / settings.pose.history_step_s > 10'000) {
    faults.add(nowhere, "pose.history", "must not be over 10000 times pose.history_step");
  }
  if (settings.realtime.loader_priority >= settings.realtime.priority) {
    faults.add(nowhere, "realtime.loader_priority", "must be below realtime.priority");
  }
  const std::string& cpu = settings.realtime.cpu;
  if (cpu.size() > 4 || cpu.find_first_not_of("0123456789") != std::string::npos) {
    faults.add(nowhere, "realtime.cpu",
               "\"" + cpu + "\" is no number of a processor; expected 0, 1, ...");
  }
  if (settings.odometry.wheels.timeout_s < 2 / settings.cycle.period_hz) {
    faults.add(nowhere, "odometry.timeout", "must be at least two cycles (cycle.period_hz)");
  }
  for (const auto& [key, mode] : {std::pair("serve.mode", settings.serve.mode),
                                  std::pair("serve.looking_mode", settings.serve.looking_mode)}) {
    if (!socket_mode(mode)) {
      faults.add(nowhere, key, "\"" + mode + "\" is no mode; expected octal digits such as 0660");
    }
  }
}

void read_file(const YAML::Node& root, const std::string& path, Settings& settings,
               FaultList& faults) {
  YamlSection file(root, "", faults);
  read_section(file, "map", map_fields(), settings.map, faults);
  read_section(file, "memory", memory_fields(), settings.memory, faults);
  read_section(file, "loading", loading_fields(), settings.loading, faults);
  // Before the signals, whose timeouts count in cycles.
  read_section(file, "cycle", cycle_fields(), settings.cycle, faults);
  read_section(file, "serve", serve_fields(), settings.serve, faults);
  read_odometry(file, path, settings, faults);
  read_section(file, "pose", pose_fields(), settings.pose, faults);
  read_section(file, "zones", zones_fields(), settings.zones, faults);
  read_section(file, "preload", preload_fields(), settings.preload, faults);
  read_section(file, "realtime", realtime_fields(), settings.realtime, faults);
  read_section(file, "recorder", recorder_fields(), settings.recorder, faults);
  read_section(file, "state", state_fields(), settings.state, faults);
  read_gpio(file, settings.gpio, faults);
  file.finish();
  check_together(settings, faults);
  for (std::string* const folder :
       {&settings.map.path, &settings.state.folder, &settings.preload.transitions}) {
    if (!folder->empty()) *folder = beside(path, *folder);
  }
}

}  // namespace

LoadedSettings parse_settings(const std::string& text, const std::string& path,
                              const std::string& dbc_text) {
  LoadedSettings loaded;
  loaded.text = text;
  loaded.settings.can.dbc_text = dbc_text;
  FaultList faults(path);
  try {
    if (!fits_yaml_limits(text, faults)) {
      loaded.faults = faults.take();
      return loaded;
    }
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      faults.add(documents[1].Mark(), "", "a second document; expected one (remove the ---)");
    }
    read_file(documents.empty() ? YAML::Node() : documents[0], path, loaded.settings, faults);
  } catch (const YAML::Exception& error) {
    faults.add(error.mark, "", "not YAML: " + error.msg);
  }
  loaded.faults = faults.take();
  loaded.warnings = faults.take_warnings();
  return loaded;
}

LoadedSettings load_settings(const std::string& path) {
  LoadedSettings failed;
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  if (file) {
    text.resize(kLargestFile + 1);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(file.gcount()));
  }
  if (text.empty()) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "empty or not a file";
    failed.faults = {path + ": cannot be read: " + reason + "; expected a settings file (YAML)"};
    return failed;
  }
  if (const std::string kind = stand_in(text, path); !kind.empty()) {
    failed.faults = {path + ": is " + kind + "; expected a settings file (YAML)"};
    return failed;
  }
  if (text.size() > kLargestFile) {
    failed.faults = {path + ": over 1 MiB; expected a settings file (YAML)"};
    return failed;
  }
  return parse_settings(text, path);
}

Outcome<LoadedSettings> load_usable_settings(const std::string& path) {
  LoadedSettings loaded = load_settings(path);
  if (loaded.ok()) return loaded;
  std::string all = "settings cannot be used";
  for (const std::string& fault : loaded.faults) all += "\n  " + fault;
  return failure(all);
}

}  // namespace zonepack
