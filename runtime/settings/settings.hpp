// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "runtime/odometry/can_signals.hpp"
#include "runtime/odometry/pose_filter.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/zones/preload.hpp"
#include "runtime/zones/tracker.hpp"

// The settings file: YAML, strict. config/SETTINGS.md lists every key; config/agilex.yaml is the
// commented example. A new key is one line in settings_tables.cpp.
namespace zonepack {

struct MapSettings {
  std::string
      path;  // relative paths are made relative to the settings file's folder; empty: not given
};

struct PayloadChoice {
  PayloadMask mask = kDefaultPayload;
};

struct MemorySettings {
  std::optional<ByteCount> budget;   // nothing: see limits_for()
  std::uint64_t max_signatures = 0;  // 0: no such limit
  PayloadChoice payload;
  std::vector<std::string> pinned;  // names of zones that stay
  double lease_s = 2;               // how long a reader may hold a zone
};

// How fast loading is taken to be, for preloading and for simulated time.
struct LoadingSettings {
  double storage_rate = 50'000'000;  // stored bytes per second
  double decode_rate = 500'000'000;  // decoded bytes per second
};

struct CanSettings {
  std::string interface;                     // empty: any
  std::string dbc;                           // as map.path; empty: not given
  std::map<std::string, CanSignal> signals;  // and those of the DBC file that odometry names
};

enum class WheelUnit : std::uint8_t { kMetres, kRadians, kTurns };

// WheelOdometrySettings with its signals by name.
struct OdometrySettings {
  WheelUnit unit = WheelUnit::kMetres;  // of wheel signals after factor and offset
  double wheel_radius_m = 0.14;         // for radians and turns
  double scale = 1;                     // true over reported distance, from a calibration run
  std::string left, right;              // names in can.signals, for positions and speeds
  std::string forward, yaw_rate;        // for twist
  WheelOdometrySettings wheels;         // complete once loaded
};

struct CycleSettings {
  double period_hz = 100;
  std::uint32_t most_frames = 64;  // taken from the bus in one cycle
};

// How the threads of `zoned run` run.
struct RealtimeSettings {
  std::uint32_t priority = 80;         // SCHED_FIFO, control
  std::uint32_t loader_priority = 40;  // SCHED_FIFO, loader
  std::string cpu;                     // the control thread's only processor; empty: any
  bool lock_memory = true;
};

struct Settings {
  MapSettings map;
  MemorySettings memory;
  LoadingSettings loading;
  CanSettings can;
  OdometrySettings odometry;
  PoseFilterSettings pose;
  TrackerSettings zones;
  PreloadSettings preload;
  CycleSettings cycle;
  RealtimeSettings realtime;
};

struct LoadedSettings {
  Settings settings;  // meaningful without faults only
  std::vector<std::string>
      faults;  // all there are: "file:line: key: what is wrong; what is allowed"
  bool ok() const noexcept { return faults.empty(); }
};

// Reads a settings file, and the DBC file that it names. Never throws.
LoadedSettings load_settings(const std::string& path);

// The same for a text; `path` stands in messages, and map.path and can.dbc are relative to its
// folder.
LoadedSettings parse_settings(const std::string& text, const std::string& path);

// Every section and key with type, range, unit, default and meaning, as Markdown:
// config/SETTINGS.md.
std::string settings_reference();

}  // namespace zonepack
