// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/field.hpp"

namespace zonepack {

constexpr double kMost = 9e15;  // limits nothing: SETTINGS.md says "or more"

const Fields<MapSettings>& map_fields() {
  using S = MapSettings;
  static const Fields<S> fields = {
      {"path", &S::path, 0, 0, "", "folder of the map; --map replaces it"},
  };
  return fields;
}

const Fields<MemorySettings>& memory_fields() {
  using S = MemorySettings;
  static const Fields<S> fields = {
      {"budget", &S::budget, 0, 0, "",
       "hard limit of all memory that grows with the map; --budget"},
      {"max_signatures", &S::max_signatures, 0, kMost, "signatures",
       "most signatures in memory at once; 0: no limit; --max-signatures"},
      {"payload", &S::payload, 0, 0, "",
       "what is loaded of every signature besides its core (pose and links)"},
      {"pinned", &S::pinned, 0, 0, "", "names of zones that are never unloaded"},
      {"layers", &S::layers, 0, 0, "",
       "names of layers (zonepack build --layer): zones of others are never loaded; []: all"},
  };
  return fields;
}

const Fields<LoadingSettings>& loading_fields() {
  using S = LoadingSettings;
  static const Fields<S> fields = {
      {"read", &S::read, 0, 0, "",
       "direct: past the page cache, several requests at once (buffered where the file system "
       "has no such reads); mapped: from mapped windows; buffered: through the page cache. None "
       "leaves more than 4 MiB in the cache"},
      {"rate_limit", &S::rate_limit, 0, 1e12, "bytes/s",
       "most that is read from packs in a second; 0: no limit"},
      {"storage_rate", &S::storage_rate, 1000, 1e12, "bytes/s",
       "how fast packs are read; --storage-rate"},
      {"decode_rate", &S::decode_rate, 1000, 1e12, "bytes/s",
       "how fast they are decoded, in decoded bytes"},
  };
  return fields;
}

const Fields<CanSettings>& can_fields() {
  using S = CanSettings;
  static const Fields<S> fields = {
      {"interface", &S::interface, 0, 0, "", "the bus whose frames are read; empty: any"},
      {"dbc", &S::dbc, 0, 0, "",
       "DBC file; its signals are named MESSAGE.SIGNAL and come in addition to can.signals. "
       "MESSAGE@ID.SIGNAL where messages share a name"},
  };
  return fields;
}

const Fields<SignalText>& signal_fields() {
  using S = SignalText;
  static const Fields<S> fields = {
      {"id", &S::id, 0, 0x1FFFFFFF, "", "CAN id; above 0x7FF only with extended: true"},
      {"extended", &S::extended, 0, 0, "", "whether the id has 29 bits"},
      {"start", &S::start, 0, 511, "", "DBC start bit: the lowest (little) or highest bit (big)"},
      {"length", &S::length, 1, 64, "bits", "number of bits"},
      {"byte_order", &S::byte_order, 0, 0, "", "little is Intel, big is Motorola"},
      {"type", &S::type, 0, 0, "", "how the bits are read"},
      {"factor", &S::factor, -kMost, kMost, "", "value = raw * factor + offset; not 0"},
      {"offset", &S::offset, -kMost, kMost, "", "see factor"},
  };
  return fields;
}

const Fields<MultiplexText>& multiplex_fields() {
  using S = MultiplexText;
  static const Fields<S> fields = {
      {"start", &S::start, 0, 511, "", "the same as for a signal"},
      {"length", &S::length, 1, 64, "bits", "the same as for a signal"},
      {"byte_order", &S::byte_order, 0, 0, "", "the same as for a signal"},
      {"value", &S::value, 0, kMost, "",
       "the signal is present when the multiplexer has this value"},
  };
  return fields;
}

const Fields<CanOpenWatchSettings>& canopen_fields() {
  using S = CanOpenWatchSettings;
  static const Fields<S> fields = {
      {"heartbeat_timeout", &S::heartbeat_timeout_s, 0.01, 60, "s",
       "a watched node that is silent for this long is lost: its data is refused and odometry goes "
       "stale"},
      {"sync_timeout", &S::sync_timeout_s, 0, 60, "s", "the same for SYNC; 0: SYNC is not watched"},
      {"sync_id", &S::sync_id, 1, 0x7FF, "", "CAN id of SYNC"},
  };
  return fields;
}

const Fields<CanOpenNodeText>& canopen_node_fields() {
  using S = CanOpenNodeText;
  static const Fields<S> fields = {
      {"node", &S::node, 1, 127, "", "node id"},
      {"heartbeat", &S::heartbeat, 0, 0, "",
       "whether its heartbeat is watched; the node must then be operational"},
      {"tpdo1", &S::tpdo1, 0, 0, "",
       "mapped objects, as in object 0x1A00: [0x60410010, 0x60640020] makes the signals NAME.6041 "
       "and NAME.6064 (with another sub-index: NAME.2106sub1)"},
      {"tpdo2", &S::tpdo2, 0, 0, "", "the same for 0x1A01"},
      {"tpdo3", &S::tpdo3, 0, 0, "", "the same for 0x1A02"},
      {"tpdo4", &S::tpdo4, 0, 0, "", "the same for 0x1A03"},
      {"tpdo1_id", &S::tpdo1_id, 0, 0x7FF, "", "CAN id; 0 means 0x180 + node"},
      {"tpdo2_id", &S::tpdo2_id, 0, 0x7FF, "", "CAN id; 0 means 0x280 + node"},
      {"tpdo3_id", &S::tpdo3_id, 0, 0x7FF, "", "CAN id; 0 means 0x380 + node"},
      {"tpdo4_id", &S::tpdo4_id, 0, 0x7FF, "", "CAN id; 0 means 0x480 + node"},
  };
  return fields;
}

const Fields<WheelGeometry>& geometry_fields() {
  using S = WheelGeometry;
  static const Fields<S> fields = {
      {"track", &S::track_m, 0.01, 20, "m", "between left and right contact points"},
      {"slip_factor", &S::slip_factor, 0.5, 10, "",
       "skid steering: how many times more the wheels turn than the track alone explains"},
      {"wheelbase", &S::wheelbase_m, 0.01, 20, "m", "ackermann, mecanum: front to rear axle"},
      {"omni_radius", &S::omni_radius_m, 0.01, 10, "m",
       "omni: from the robot's centre to each wheel"},
      {"omni_bearing", &S::omni_bearing_rad, -7, 7, "rad",
       "omni: bearing of the first wheel from the centre; 0 is ahead"},
  };
  return fields;
}

const Fields<OdometrySettings>& odometry_fields() {
  using S = OdometrySettings;
  static const Fields<S> fields = {
      {"unit", &S::unit, 0, 0, "",
       "unit of the wheel signals and of twist's forward speed (per second, for speeds). A unit "
       "that the DBC file gives (km/h, mph, deg/s, rpm ...) is converted; one that contradicts "
       "this key is refused"},
      {"angle_unit", &S::angle_unit, 0, 0, "",
       "unit of steering and (per second) yaw_rate, where the DBC file gives none"},
      {"wheel_radius", &S::wheel_radius_m, 0.001, 10, "m",
       "for every unit except metres, mm and km/h"},
      {"gear", &S::gear, 0.0001, 100000, "",
       "turns of the motor, which the signals count, for one turn of the wheel"},
      {"pole_pairs", &S::pole_pairs, 1, 1000, "", "pole pairs of the motor, for erpm"},
      {"ticks_per_turn", &S::ticks_per_turn, 0, 1e12, "",
       "ticks of the encoder for one turn, for ticks"},
      {"full_scale", &S::full_scale, 0, 1e9, "",
       "what 100 % is, in unit, for signals that the DBC file gives in %; 0: not given"},
      {"scale", &S::scale, 0.5, 2, "",
       "true distance over reported distance; zoned calibrate estimates this key, scale_left, "
       "scale_right and track"},
      {"scale_left", &S::scale_left, 0.5, 2, "", "the same for the wheels on the left only"},
      {"scale_right", &S::scale_right, 0.5, 2, "", "the same for the wheels on the right only"},
      {"invert", &S::invert, 0, 0, "",
       "keys of signals that count backwards: [right]; for omni wheels [\"1\", \"3\"]"},
      {"left", &S::left, 0, 0, "",
       "signal of the left wheel: a name from can.signals, or MESSAGE.SIGNAL from can.dbc"},
      {"right", &S::right, 0, 0, "", "signal of the right wheel"},
      {"forward", &S::forward, 0, 0, "",
       "twist: signal of the forward speed; ackermann: signal of the driven axle, in unit"},
      {"yaw_rate", &S::yaw_rate, 0, 0, "", "twist: signal of the yaw rate"},
      {"steering", &S::steering, 0, 0, "",
       "ackermann: signal of the steering angle; left is positive"},
      {"front_left", &S::front_left, 0, 0, "", "mecanum: signal of that wheel"},
      {"front_right", &S::front_right, 0, 0, "", "the same"},
      {"rear_left", &S::rear_left, 0, 0, "", "the same"},
      {"rear_right", &S::rear_right, 0, 0, "", "the same"},
      {"around", &S::around, 0, 0, "",
       "omni: signals of 3 or 4 wheels evenly around the centre, counter-clockwise"},
  };
  return fields;
}

const Fields<WheelOdometrySettings>& wheel_fields() {
  using S = WheelOdometrySettings;
  static const Fields<S> fields = {
      {"model", &S::model, 0, 0, "", "what the signals measure"},
      {"steering_offset", &S::steering_offset_rad, -3, 3, "rad",
       "ackermann: added to the steering angle"},
      {"max_speed", &S::max_speed_m_s, 0.01, 100, "m/s", "a faster sample is refused"},
      {"max_yaw_rate", &S::max_yaw_rate_rad_s, 0.01, 100, "rad/s", "the same for turning"},
      {"max_acceleration", &S::max_acceleration_m_s2, 0.1, 1000, "m/s2",
       "the same for a wheel's acceleration between samples"},
      {"gap", &S::gap_s, 0.01, 60, "s", "a longer pause between samples is a gap"},
      {"timeout", &S::timeout_s, 0.01, 60, "s",
       "after this long without samples, uncertainty grows. If absent, and can.dbc gives "
       "GenMsgCycleTime: 3 times the longest of the messages read, at least two cycles"},
      {"sigma_forward_per_sqrt_m", &S::sigma_forward_per_sqrt_m, 0, 10, "m",
       "noise of 1 m of way: along it"},
      {"sigma_sideways_per_sqrt_m", &S::sigma_sideways_per_sqrt_m, 0, 10, "m",
       "noise of 1 m of way: across it (slip)"},
      {"sigma_yaw_per_sqrt_m", &S::sigma_yaw_per_sqrt_m, 0, 10, "rad",
       "noise of 1 m of way: heading"},
      {"sigma_forward_per_sqrt_rad", &S::sigma_forward_per_sqrt_rad, 0, 10, "m",
       "noise of a turn by 1 rad: along the way"},
      {"sigma_yaw_per_sqrt_rad", &S::sigma_yaw_per_sqrt_rad, 0, 10, "rad",
       "noise of a turn by 1 rad: heading"},
      {"sigma_gap_per_m", &S::sigma_gap_per_m, 0, 10, "",
       "positions: how far off the end of a gap may be, as a share of its length"},
      {"sigma_gap_per_s", &S::sigma_gap_m_per_s, 0, 100, "m/s",
       "speeds, and positions that jumped: distance that may be missing, for each second of a gap"},
      {"sigma_gap_yaw_per_s", &S::sigma_gap_rad_per_s, 0, 100, "rad/s", "the same for the heading"},
  };
  return fields;
}

const Fields<PoseFilterSettings>& pose_fields() {
  using S = PoseFilterSettings;
  static const Fields<S> fields = {
      {"gate", &S::gate_chi2, 1, 1000, "",
       "squared Mahalanobis distance up to which a fix is accepted; chi-squared with 3 degrees of "
       "freedom: 16.27 is 99.9 %"},
      {"history", &S::history_s, 0.1, 60, "s", "how late a fix may arrive"},
      {"history_step", &S::history_step_s, 0.001, 1, "s",
       "odometry steps shorter than this share an entry of the history"},
      {"future_tolerance", &S::future_tolerance_s, 0, 10, "s",
       "how far in the future a fix may be stamped"},
      {"min_sigma", &S::min_sigma_m, 1e-6, 10, "m", "no fix counts as more accurate than this"},
      {"min_sigma_yaw", &S::min_sigma_rad, 1e-6, 3, "rad", "the same for the heading"},
      {"reinit_fixes", &S::reinit_fixes, 2, 100, "",
       "rejected fixes in a row that agree with each other, and then move the pose"},
      {"start_sigma", &S::start_sigma_m, 0.001, 1000, "m",
       "uncertainty of a start pose that is given"},
      {"start_sigma_yaw", &S::start_sigma_rad, 0.001, 10, "rad", "the same for the heading"},
      {"drift_sigma_per_sqrt_s", &S::drift_sigma_m_per_sqrt_s, 0, 100, "m",
       "growth of the uncertainty in 1 s without odometry"},
      {"drift_sigma_yaw_per_sqrt_s", &S::drift_sigma_rad_per_sqrt_s, 0, 100, "rad",
       "the same for the heading"},
      {"speed_filter", &S::speed_filter_s, 0, 10, "s", "time constant of the speed filter"},
      {"extrapolate", &S::extrapolate_s, 0, 1, "s",
       "how far the newest odometry is extrapolated to the present"},
  };
  return fields;
}

const Fields<TrackerSettings>& zones_fields() {
  using S = TrackerSettings;
  static const Fields<S> fields = {
      {"least_depth", &S::least_depth_m, 0, 10, "m",
       "how deep in a neighbouring zone the pose must be: one sigma, but at least this ..."},
      {"most_depth", &S::most_depth_m, 0, 10, "m", "... and at most this"},
      {"wall_depth", &S::wall_depth_m, 0, 10, "m", "where no portal leads: this plus three sigma"},
      {"start_radius", &S::start_radius_m, 0, 100, "m",
       "a pose outside every zone starts in the nearest one within this plus three sigma"},
  };
  return fields;
}

const Fields<PreloadSettings>& preload_fields() {
  using S = PreloadSettings;
  static const Fields<S> fields = {
      {"margin", &S::margin_m, 0, 10, "m",
       "how far ahead a zone must be ready, in addition to three sigma"},
      {"motion_average", &S::motion_average_s, 0, 10, "s",
       "time over which the motion is smoothed"},
      {"standing", &S::standing_m_s, 0, 10, "m/s", "slower than this counts as standing"},
      {"hold", &S::hold_s, 0, 60, "s", "an approach that is not seen for this long is given up"},
      {"most_turn", &S::most_turn_rad, 0, 6.3, "rad",
       "how far the present arc is followed; then the path goes on straight"},
      {"most_reach", &S::most_reach_m, 0, 1000, "m", "how far any path is followed"},
  };
  return fields;
}

const Fields<CycleSettings>& cycle_fields() {
  using S = CycleSettings;
  static const Fields<S> fields = {
      {"period_hz", &S::period_hz, 1, 1000, "Hz", "control cycles per second"},
      {"most_frames", &S::most_frames, 1, 4096, "",
       "CAN frames taken in one cycle; the others wait"},
  };
  return fields;
}

const Fields<RealtimeSettings>& realtime_fields() {
  using S = RealtimeSettings;
  static const Fields<S> fields = {
      {"priority", &S::priority, 1, 99, "", "SCHED_FIFO priority of the control thread"},
      {"loader_priority", &S::loader_priority, 1, 98, "",
       "the same for the loader; must be below priority"},
      {"cpu", &S::cpu, 0, 0, "",
       "number of the only processor that the control thread may use; empty: any"},
      {"lock_memory", &S::lock_memory, 0, 0, "", "whether all pages stay in memory (mlockall)"},
  };
  return fields;
}

const Fields<RecorderSettings>& recorder_fields() {
  using S = RecorderSettings;
  static const Fields<S> fields = {
      {"bytes", &S::bytes, 0, kMost, "bytes",
       "how much of the newest inputs is kept, with the maps that they need, at least 2 MiB; 0: "
       "off"},
  };
  return fields;
}

const Fields<StateSettings>& state_fields() {
  using S = StateSettings;
  static const Fields<S> fields = {
      {"folder", &S::folder, 0, 0, "",
       "folder of the pose and the flight recorder; empty: $STATE_DIRECTORY, or nowhere without "
       "it"},
  };
  return fields;
}

const Fields<GpioSettings>& gpio_fields() {
  using S = GpioSettings;
  static const Fields<S> fields = {
      {"heartbeat_period", &S::heartbeat_s, 0.02, 10, "s",
       "period of the square wave of heartbeat, which goes on only while control cycles run and "
       "the other "
       "outputs can be set"},
  };
  return fields;
}

const Fields<OutputLine>& output_line_fields() {
  using S = OutputLine;
  static const Fields<S> fields = {
      {"chip", &S::chip, 0, 0, "", "label, name (gpiochip0) or file (/dev/gpiochip0); required"},
      {"line", &S::line, 0, 0, "", "number or name; required"},
      {"active_low", &S::active_low, 0, 0, "", "whether a low voltage means active"},
      {"safe", &S::safe, 0, 0, "",
       "the level while no zoned drives the line, and at the start until the state is known; "
       "usual: "
       "active for fault, inactive for the others"},
  };
  return fields;
}

const Fields<InputLine>& input_line_fields() {
  using S = InputLine;
  static const Fields<S> fields = {
      {"chip", &S::chip, 0, 0, "", "the same as for an output; required"},
      {"line", &S::line, 0, 0, "", "number or name; required"},
      {"active_low", &S::active_low, 0, 0, "",
       "whether a low voltage means active, as with a contact to ground"},
      {"bias", &S::bias, 0, 0, "", "the chip's own resistor"},
      {"debounce", &S::debounce_s, 0, 10, "s", "a level counts once it has lasted this long"},
  };
  return fields;
}

const Fields<DockPlace>& dock_fields() {
  using S = DockPlace;
  static const Fields<S> fields = {
      {"x", &S::x_m, -1e6, 1e6, "m", "where base_link is in the map when the contact closes"},
      {"y", &S::y_m, -1e6, 1e6, "m", "the same"},
      {"yaw", &S::yaw_rad, -7, 7, "rad", "the same"},
      {"sigma", &S::sigma_m, 1e-4, 10, "m", "uncertainty of that position"},
      {"sigma_yaw", &S::sigma_rad, 1e-4, 3, "rad", "the same for the heading"},
  };
  return fields;
}

const Fields<MarkerPlace>& marker_fields() {
  using S = MarkerPlace;
  static const Fields<S> fields = {
      {"zones", &S::zones, 0, 0, "",
       "the two zones on either side of the marked door, or the one zone that holds the beacon; "
       "required"},
      {"reach", &S::reach_m, 0.01, 100, "m",
       "the marker is believed if the pose is within this plus three sigma of the portal"},
  };
  return fields;
}

const Fields<ServeSettings>& serve_fields() {
  using S = ServeSettings;
  static const Fields<S> fields = {
      {"socket", &S::socket, 0, 0, "",
       "local socket for other programs; auto: /run/zoned/zoned.sock, and "
       "$XDG_RUNTIME_DIR/zonepack/zoned.sock for a user other than root who has one; \"\": none; "
       "--socket"},
      {"mode", &S::mode, 0, 0, "",
       "mode of the socket file, in octal as for chmod: who may use it"},
      {"group", &S::group, 0, 0, "",
       "group of the socket files, by its name; zoned's user must be in it; empty: its own"},
      {"looking_socket", &S::looking_socket, 0, 0, "",
       "a second socket, through which nothing can be changed; empty: none"},
      {"looking_mode", &S::looking_mode, 0, 0, "", "mode of that socket file"},
      {"clients", &S::clients, 1, 1000, "", "most programs connected at once"},
      {"requests", &S::requests_per_s, 1, 1e6, "1/s",
       "most requests of one program; further ones wait"},
      {"lease", &S::lease_s, 0.01, 3600, "s",
       "how long a reader may hold a zone before it must ask again"},
  };
  return fields;
}

}  // namespace zonepack
