// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "platform/base/byte_count.hpp"
#include "platform/base/failure.hpp"
#include "platform/files/storage.hpp"
#include "runtime/control/eviction_rule.hpp"
#include "runtime/odometry/can_signals.hpp"
#include "runtime/odometry/pose_filter.hpp"
#include "runtime/odometry/wheel_odometry.hpp"
#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/settings/gpio_settings.hpp"
#include "runtime/settings/serve_settings.hpp"
#include "runtime/zones/preload.hpp"
#include "runtime/zones/tracker.hpp"

// The settings file: YAML, strict. config/SETTINGS.md lists every key; config/agilex.yaml is the
// commented example. A new key is one line in settings_tables.cpp.
namespace zonepack {

struct MapSettings {
  std::string path;  // relative to the settings file's folder; empty: not given
};

struct PayloadChoice {
  PayloadMask mask = kDefaultPayload;
};

struct MemorySettings {
  std::optional<ByteCount> budget;   // nothing: see limits_for()
  std::uint64_t max_signatures = 0;  // 0: no such limit
  PayloadChoice payload;
  EvictionRule eviction = EvictionRule::kLru;
  std::vector<std::string> pinned;  // names of zones that are never evicted
  std::vector<std::string> layers;  // of which zones are loaded; empty: all
};

// How packs are read, and how fast loading is assumed to be, for preloading and simulated time.
struct LoadingSettings {
  ReadMode read = kDefaultReadMode;
  std::uint64_t rate_limit = 0;      // bytes per second, 0: none
  double storage_rate = 50'000'000;  // stored bytes per second
  double decode_rate = 500'000'000;  // decoded bytes per second

  // Stored bytes per second to assume.
  double expected_storage_rate() const noexcept {
    const auto limit = static_cast<double>(rate_limit);
    return rate_limit != 0 && limit < storage_rate ? limit : storage_rate;
  }
};

struct CanSettings {
  std::string interface;  // empty: any
  std::string dbc;        // relative as map.path is; empty: not given
  std::string dbc_text;   // the text of that file
  // Those of can.signals, those of CANopen process data as NODE.INDEX, and those of the DBC file
  // that odometry names.
  std::map<std::string, CanSignal> signals;
  CanOpenWatchSettings canopen;
};

// Units of wheels or, before the gear, of their motors. rpm: turns a minute; erpm: electrical turns
// a minute; ticks: of an encoder. All but lengths depend on the wheel's radius.
enum class WheelUnit : std::uint8_t {
  kMetres,
  kRadians,
  kTurns,
  kRpm,
  kErpm,
  kTicks,
  kKilometresPerHour,
  kDegrees,
  kMillimetres
};
inline bool is_length(WheelUnit unit) noexcept {
  return unit == WheelUnit::kMetres || unit == WheelUnit::kKilometresPerHour ||
         unit == WheelUnit::kMillimetres;
}

// Unit of a steering angle and, per second, of a yaw rate.
enum class AngleUnit : std::uint8_t { kRadians, kDegrees };

// WheelOdometrySettings with its signals by name.
struct OdometrySettings {
  WheelUnit unit = WheelUnit::kMetres;         // of wheel signals after factor and offset
  AngleUnit angle_unit = AngleUnit::kRadians;  // where the DBC file gives none
  double wheel_radius_m = 0.14;                // for all but lengths
  double gear = 1;            // turns of the motor for one of the wheel; not for metres
  double pole_pairs = 1;      // of the motor, for erpm
  double ticks_per_turn = 0;  // of what turns the encoder, for ticks; 0: not given
  double full_scale = 0;      // what 100 % is, in `unit`, for signals in %; 0: not given
  double scale = 1;           // true over reported distance, from a calibration run
  double scale_left = 1;      // on top of scale, for the wheels of one side
  double scale_right = 1;
  std::vector<std::string> invert;  // keys of signals that count backwards
  std::string left, right;          // names of signals: differential
  std::string forward, yaw_rate;    // twist; forward is also Ackermann's driven axle
  std::string steering;             // Ackermann
  std::string front_left, front_right, rear_left, rear_right;  // mecanum
  std::vector<std::string> around;                             // omni, counter-clockwise
  WheelOdometrySettings wheels;                                // complete once loaded
};

// A key of the section odometry (of omni wheels their number, from 1) and the signal that it names.
struct SignalKey {
  std::string key;  // also as in `invert`
  std::string name;
};

// Those that the model reads, in its order.
std::vector<SignalKey> signal_keys(const OdometrySettings& odometry);

// Ground covered per unit of a wheel's signal, both sides alike.
double metres_per_unit(const OdometrySettings& odometry);

struct CycleSettings {
  double period_hz = 100;
  std::uint32_t most_frames = 64;  // taken from the bus in one cycle
};

// Scheduling and memory locking of `zoned run`.
struct RealtimeSettings {
  std::uint32_t priority = 80;         // SCHED_FIFO, control
  std::uint32_t loader_priority = 40;  // SCHED_FIFO, loader
  std::string cpu;                     // the control thread's only processor; empty: any
  bool lock_memory = true;
};

// The flight recorder of `zoned run`.
struct RecorderSettings {
  std::uint64_t bytes = 64 * kMiB;  // kept of the newest inputs; 0: off
};

// What survives a restart.
struct StateSettings {
  std::string folder;  // relative as map.path is; empty: $STATE_DIRECTORY, else nowhere
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
  ServeSettings serve;
  RealtimeSettings realtime;
  RecorderSettings recorder;
  StateSettings state;
  GpioSettings gpio;
};

struct LoadedSettings {
  Settings settings;                  // meaningful only without faults
  std::vector<std::string> faults;    // all: "file:line: key: what is wrong; what is allowed"
  std::vector<std::string> warnings;  // complete messages; the settings can be used all the same
  std::string text;                   // the file's
  bool ok() const noexcept { return faults.empty(); }
};

// Reads a settings file, and the DBC file that it names. Never throws.
LoadedSettings load_settings(const std::string& path);

// The same for programs: with faults, a failure that lists them all, one a line.
Outcome<LoadedSettings> load_usable_settings(const std::string& path);

// The same for a text; messages name `path`, and map.path and can.dbc are relative to its folder.
// dbc_text, unless empty, replaces the file that can.dbc names.
LoadedSettings parse_settings(const std::string& text, const std::string& path,
                              const std::string& dbc_text = {});

// Every section and key with type, range, unit, default and meaning, as Markdown:
// config/SETTINGS.md.
std::string settings_reference();

}  // namespace zonepack
