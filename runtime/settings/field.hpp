// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "runtime/settings/settings.hpp"

namespace zonepack {

// A largest value that limits nothing: SETTINGS.md says "or more".
inline constexpr double kNoMost = 9e15;

// Where a key's value stands. A visitor of these is compiled once, not for each section.
using FieldValue = std::variant<double*, std::uint32_t*, std::uint64_t*, bool*, std::string*,
                                std::vector<std::string>*, std::optional<ByteCount>*,
                                PayloadChoice*, OdometryModel*, WheelUnit*, AngleUnit*, ByteOrder*,
                                SignalType*, ReadMode*, GpioBias*, SafeLevel*, EvictionRule*>;

// What is allowed of a key, whatever its section. A number must lie in [least, most]; other kinds
// ignore these.
struct FieldLimits {
  double least;
  double most;
  const char* unit;
};

// One key of a section: its name, where its value stands in the section, what is allowed, what it
// means.
template <typename Section>
struct Field {
  const char* key;
  FieldValue (*value)(Section&);
  double least;
  double most;
  const char* unit;
  const char* meaning;

  FieldLimits limits() const noexcept { return {least, most, unit}; }
};

// For Field::value: the member of a section.
template <auto kMember, typename Section>
FieldValue in(Section& section) {
  return &(section.*kMember);
}

template <typename Section>
using Fields = std::vector<Field<Section>>;

// The words of an enumeration, in the order of its values.
template <typename Enum>
struct EnumWords;
template <>
struct EnumWords<OdometryModel> {
  static constexpr const char* kWords[] = {
      "differential-positions", "wheel-speeds",     "twist",
      "ackermann-positions",    "ackermann-speeds", "mecanum-positions",
      "mecanum-speeds",         "omni-positions",   "omni-speeds"};
};
template <>
struct EnumWords<WheelUnit> {
  static constexpr const char* kWords[] = {"metres", "radians", "turns",   "rpm", "erpm",
                                           "ticks",  "km/h",    "degrees", "mm"};
};
template <>
struct EnumWords<AngleUnit> {
  static constexpr const char* kWords[] = {"radians", "degrees"};
};
template <>
struct EnumWords<ByteOrder> {
  static constexpr const char* kWords[] = {"little", "big"};
};
template <>
struct EnumWords<SignalType> {
  static constexpr const char* kWords[] = {"unsigned", "signed", "float", "double"};
};

template <>
struct EnumWords<ReadMode> {  // kCached is for tools
  static constexpr const char* kWords[] = {"direct", "mapped", "buffered"};
};

template <>
struct EnumWords<EvictionRule> {
  static constexpr const char* kWords[] = {"lru", "expected"};
};

template <>
struct EnumWords<GpioBias> {
  static constexpr const char* kWords[] = {"as-is", "none", "pull-up", "pull-down"};
};
template <>
struct EnumWords<SafeLevel> {
  static constexpr const char* kWords[] = {"usual", "active", "inactive"};
};

// A signal as written in the file; a key whose default is out of range is mandatory.
struct SignalText {
  std::uint32_t id = 0xFFFFFFFF;
  bool extended = false;
  std::uint32_t start = 0;
  std::uint32_t length = 0;
  ByteOrder byte_order = ByteOrder::kLittle;
  SignalType type = SignalType::kUnsigned;
  double factor = 1;
  double offset = 0;
};
struct MultiplexText {
  std::uint32_t start = 0;
  std::uint32_t length = 0;
  ByteOrder byte_order = ByteOrder::kLittle;
  std::uint64_t value = 0;
};

// A node under can.canopen.nodes.
struct CanOpenNodeText {
  std::uint32_t node = 0;
  bool heartbeat = true;
  std::vector<std::string> tpdo1, tpdo2, tpdo3, tpdo4;
  std::uint32_t tpdo1_id = 0, tpdo2_id = 0, tpdo3_id = 0, tpdo4_id = 0;
};

// The tables (settings_tables.cpp).
const Fields<MapSettings>& map_fields();
const Fields<MemorySettings>& memory_fields();
const Fields<LoadingSettings>& loading_fields();
const Fields<CanSettings>& can_fields();
const Fields<SignalText>& signal_fields();
const Fields<MultiplexText>& multiplex_fields();
const Fields<CanOpenWatchSettings>& canopen_fields();
const Fields<CanOpenNodeText>& canopen_node_fields();
const Fields<OdometrySettings>& odometry_fields();
const Fields<WheelGeometry>& geometry_fields();       // also keys of the section odometry
const Fields<WheelOdometrySettings>& wheel_fields();  // also keys of the section odometry
const Fields<PoseFilterSettings>& pose_fields();
const Fields<TrackerSettings>& zones_fields();
const Fields<PreloadSettings>& preload_fields();
const Fields<CycleSettings>& cycle_fields();
const Fields<ServeSettings>& serve_fields();
const Fields<RealtimeSettings>& realtime_fields();
const Fields<RecorderSettings>& recorder_fields();
const Fields<StateSettings>& state_fields();
const Fields<GpioSettings>& gpio_fields();
const Fields<OutputLine>& output_line_fields();
const Fields<InputLine>& input_line_fields();
const Fields<DockPlace>& dock_fields();      // also keys of gpio.dock
const Fields<MarkerPlace>& marker_fields();  // also keys of gpio.zone_markers.NAME

}  // namespace zonepack
