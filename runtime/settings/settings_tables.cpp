// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/field.hpp"

namespace zonepack {

constexpr double kMost = 9e15;  // effectively no limit

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
       "hard limit of everything that grows with the map; --budget"},
      {"max_signatures", &S::max_signatures, 0, kMost, "signatures",
       "most signatures resident at once, 0 for no limit; --max-signatures"},
      {"payload", &S::payload, 0, 0, "", "what is loaded of every signature"},
      {"pinned", &S::pinned, 0, 0, "", "names of zones that are never unloaded"},
  };
  return fields;
}

const Fields<LoadingSettings>& loading_fields() {
  using S = LoadingSettings;
  static const Fields<S> fields = {
      {"read", &S::read, 0, 0, "",
       "how packs are read: past the page cache, several requests at once (buffered where the "
       "file system has no such reads), from mapped windows, or through the cache; none leaves "
       "more than 4 MiB there"},
      {"rate_limit", &S::rate_limit, 0, 1e12, "bytes/s", "most that is read of packs, 0: no limit"},
      {"storage_rate", &S::storage_rate, 1000, 1e12, "bytes/s", "reading of packs; --storage-rate"},
      {"decode_rate", &S::decode_rate, 1000, 1e12, "bytes/s", "decoding, of decoded bytes"},
  };
  return fields;
}

const Fields<CanSettings>& can_fields() {
  using S = CanSettings;
  static const Fields<S> fields = {
      {"interface", &S::interface, 0, 0, "", "bus whose frames are read, empty for any"},
      {"dbc", &S::dbc, 0, 0, "",
       "DBC file; its signals are named MESSAGE.SIGNAL, beside those of can.signals"},
  };
  return fields;
}

const Fields<SignalText>& signal_fields() {
  using S = SignalText;
  static const Fields<S> fields = {
      {"id", &S::id, 0, 0x1FFFFFFF, "", "CAN id, 0x for hexadecimal"},
      {"extended", &S::extended, 0, 0, "", "29-bit id"},
      {"start", &S::start, 0, 511, "", "DBC start bit: the lowest (little) or highest bit (big)"},
      {"length", &S::length, 1, 64, "bits", "length"},
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
      {"start", &S::start, 0, 511, "", "as of a signal"},
      {"length", &S::length, 1, 64, "bits", "as of a signal"},
      {"byte_order", &S::byte_order, 0, 0, "", "as of a signal"},
      {"value", &S::value, 0, kMost, "", "the signal is there when the multiplexer has this value"},
  };
  return fields;
}

const Fields<CanOpenWatchSettings>& canopen_fields() {
  using S = CanOpenWatchSettings;
  static const Fields<S> fields = {
      {"heartbeat_timeout", &S::heartbeat_timeout_s, 0.01, 60, "s",
       "a watched node not heard for so long is lost: its data is refused, odometry goes stale"},
      {"sync_timeout", &S::sync_timeout_s, 0, 60, "s", "the same for SYNC; 0: it is not watched"},
      {"sync_id", &S::sync_id, 1, 0x7FF, "", "CAN id of SYNC; 128 is 0x80"},
  };
  return fields;
}

const Fields<CanOpenNodeText>& canopen_node_fields() {
  using S = CanOpenNodeText;
  static const Fields<S> fields = {
      {"node", &S::node, 1, 127, "", "node id"},
      {"heartbeat", &S::heartbeat, 0, 0, "", "its heartbeat is watched; it must be operational"},
      {"tpdo1", &S::tpdo1, 0, 0, "",
       "objects mapped, as object 0x1A00 holds them: [0x60410010, 0x60640020]; makes the signals "
       "NAME.6041 and NAME.6064 (NAME.2106sub1 of another sub-index)"},
      {"tpdo2", &S::tpdo2, 0, 0, "", "the same of 0x1A01"},
      {"tpdo3", &S::tpdo3, 0, 0, "", "the same of 0x1A02"},
      {"tpdo4", &S::tpdo4, 0, 0, "", "the same of 0x1A03"},
      {"tpdo1_id", &S::tpdo1_id, 0, 0x7FF, "", "CAN id; 0 is 0x180 + node"},
      {"tpdo2_id", &S::tpdo2_id, 0, 0x7FF, "", "CAN id; 0 is 0x280 + node"},
      {"tpdo3_id", &S::tpdo3_id, 0, 0x7FF, "", "CAN id; 0 is 0x380 + node"},
      {"tpdo4_id", &S::tpdo4_id, 0, 0x7FF, "", "CAN id; 0 is 0x480 + node"},
  };
  return fields;
}

const Fields<WheelGeometry>& geometry_fields() {
  using S = WheelGeometry;
  static const Fields<S> fields = {
      {"track", &S::track_m, 0.01, 20, "m", "between left and right contact points"},
      {"slip_factor", &S::slip_factor, 0.5, 10, "",
       "skid steering: a turn takes so much more of the wheels than the track tells"},
      {"wheelbase", &S::wheelbase_m, 0.01, 20, "m", "ackermann, mecanum: front to rear axle"},
      {"omni_radius", &S::omni_radius_m, 0.01, 10, "m", "omni: from the middle to each wheel"},
      {"omni_bearing", &S::omni_bearing_rad, -7, 7, "rad",
       "omni: of the first wheel seen from the middle; 0 is ahead"},
  };
  return fields;
}

const Fields<OdometrySettings>& odometry_fields() {
  using S = OdometrySettings;
  static const Fields<S> fields = {
      {"unit", &S::unit, 0, 0, "", "of wheel signals (per second, for speeds)"},
      {"wheel_radius", &S::wheel_radius_m, 0.001, 10, "m", "for all units but metres"},
      {"gear", &S::gear, 0.0001, 100000, "",
       "turns of the motor, which the signals tell, for one of the wheel"},
      {"pole_pairs", &S::pole_pairs, 1, 1000, "", "of the motor, for erpm"},
      {"ticks_per_turn", &S::ticks_per_turn, 0, 1e12, "", "of the encoder, for ticks"},
      {"scale", &S::scale, 0.5, 2, "",
       "true over reported distance; zoned calibrate estimates it, scale_left, scale_right, track"},
      {"scale_left", &S::scale_left, 0.5, 2, "", "the same for the wheels of the left side alone"},
      {"scale_right", &S::scale_right, 0.5, 2, "", "and of the right"},
      {"invert", &S::invert, 0, 0, "",
       "keys of signals that count the other way round: [right]; of omni wheels [\"1\", \"3\"]"},
      {"left", &S::left, 0, 0, "",
       "signal of the left wheel: a name of can.signals, or MESSAGE.SIGNAL of can.dbc"},
      {"right", &S::right, 0, 0, "", "signal of the right wheel"},
      {"forward", &S::forward, 0, 0, "",
       "twist: signal of the forward speed, m/s; ackermann: of the driven axle, in unit"},
      {"yaw_rate", &S::yaw_rate, 0, 0, "", "twist: signal of the yaw rate, rad/s"},
      {"steering", &S::steering, 0, 0, "", "ackermann: signal of the angle, rad, left is positive"},
      {"front_left", &S::front_left, 0, 0, "", "mecanum: signal of that wheel"},
      {"front_right", &S::front_right, 0, 0, "", "the same"},
      {"rear_left", &S::rear_left, 0, 0, "", "the same"},
      {"rear_right", &S::rear_right, 0, 0, "", "the same"},
      {"around", &S::around, 0, 0, "",
       "omni: signals of 3 or 4 wheels evenly around the middle, counter-clockwise"},
  };
  return fields;
}

const Fields<WheelOdometrySettings>& wheel_fields() {
  using S = WheelOdometrySettings;
  static const Fields<S> fields = {
      {"model", &S::model, 0, 0, "", "what the signals tell"},
      {"steering_offset", &S::steering_offset_rad, -3, 3, "rad",
       "ackermann: added to the steering"},
      {"max_speed", &S::max_speed_m_s, 0.01, 100, "m/s", "more is refused"},
      {"max_yaw_rate", &S::max_yaw_rate_rad_s, 0.01, 100, "rad/s", "more is refused"},
      {"max_acceleration", &S::max_acceleration_m_s2, 0.1, 1000, "m/s2",
       "of a wheel from sample to sample; more is refused"},
      {"gap", &S::gap_s, 0.01, 60, "s", "a longer pause between samples is a gap"},
      {"timeout", &S::timeout_s, 0.01, 60, "s",
       "without samples for so long, uncertainty grows; not given and can.dbc tells "
       "GenMsgCycleTime: "
       "3 times the longest of the messages read, at least two cycles"},
      {"sigma_forward_per_sqrt_m", &S::sigma_forward_per_sqrt_m, 0, 10, "m", "noise of 1 m: along"},
      {"sigma_sideways_per_sqrt_m", &S::sigma_sideways_per_sqrt_m, 0, 10, "m",
       "noise of 1 m: across (slip)"},
      {"sigma_yaw_per_sqrt_m", &S::sigma_yaw_per_sqrt_m, 0, 10, "rad", "noise of 1 m: heading"},
      {"sigma_forward_per_sqrt_rad", &S::sigma_forward_per_sqrt_rad, 0, 10, "m",
       "noise of a turn by 1 rad: along"},
      {"sigma_yaw_per_sqrt_rad", &S::sigma_yaw_per_sqrt_rad, 0, 10, "rad",
       "noise of a turn by 1 rad: heading"},
      {"sigma_gap_per_m", &S::sigma_gap_per_m, 0, 10, "",
       "positions: share of a gap's length that its end may be off"},
      {"sigma_gap_per_s", &S::sigma_gap_m_per_s, 0, 100, "m/s",
       "speeds, and positions that jumped: distance that may be missing"},
      {"sigma_gap_yaw_per_s", &S::sigma_gap_rad_per_s, 0, 100, "rad/s", "the same for the heading"},
  };
  return fields;
}

const Fields<PoseFilterSettings>& pose_fields() {
  using S = PoseFilterSettings;
  static const Fields<S> fields = {
      {"gate", &S::gate_chi2, 1, 1000, "",
       "squared Mahalanobis distance up to which a fix is believed; chi2 of 3 dof: 16.27 is 99.9 "
       "%"},
      {"history", &S::history_s, 0.1, 60, "s", "how late a fix may come"},
      {"history_step", &S::history_step_s, 0.001, 1, "s", "shorter odometry steps share an entry"},
      {"future_tolerance", &S::future_tolerance_s, 0, 10, "s", "how far ahead a stamp may be"},
      {"min_sigma", &S::min_sigma_m, 1e-6, 10, "m", "a fix is never believed to be better"},
      {"min_sigma_yaw", &S::min_sigma_rad, 1e-6, 3, "rad", "the same for its heading"},
      {"reinit_fixes", &S::reinit_fixes, 2, 100, "",
       "refused fixes that agree with each other and then move the pose"},
      {"start_sigma", &S::start_sigma_m, 0.001, 1000, "m", "of a start pose that was given"},
      {"start_sigma_yaw", &S::start_sigma_rad, 0.001, 10, "rad", "the same for its heading"},
      {"drift_sigma_per_sqrt_s", &S::drift_sigma_m_per_sqrt_s, 0, 100, "m",
       "growth in 1 s without odometry"},
      {"drift_sigma_yaw_per_sqrt_s", &S::drift_sigma_rad_per_sqrt_s, 0, 100, "rad",
       "the same for the heading"},
      {"speed_filter", &S::speed_filter_s, 0, 10, "s", "time constant of the speeds"},
      {"extrapolate", &S::extrapolate_s, 0, 1, "s",
       "how far the newest odometry is carried on to now"},
  };
  return fields;
}

const Fields<TrackerSettings>& zones_fields() {
  using S = TrackerSettings;
  static const Fields<S> fields = {
      {"least_depth", &S::least_depth_m, 0, 10, "m",
       "how deep in a neighbour the pose must be: one sigma, but at least this ..."},
      {"most_depth", &S::most_depth_m, 0, 10, "m", "... and at most this"},
      {"wall_depth", &S::wall_depth_m, 0, 10, "m", "where no portal leads: this plus three sigma"},
      {"start_radius", &S::start_radius_m, 0, 100, "m",
       "a pose outside of all zones starts in one within this plus three sigma"},
  };
  return fields;
}

const Fields<PreloadSettings>& preload_fields() {
  using S = PreloadSettings;
  static const Fields<S> fields = {
      {"margin", &S::margin_m, 0, 10, "m",
       "beside three sigma: how far ahead a zone must be ready"},
      {"motion_average", &S::motion_average_s, 0, 10, "s", "over which the motion is smoothed"},
      {"standing", &S::standing_m_s, 0, 10, "m/s", "slower than this is standing"},
      {"hold", &S::hold_s, 0, 60, "s", "an approach not seen for so long is given up"},
      {"most_turn", &S::most_turn_rad, 0, 6.3, "rad", "how far an arc is trusted"},
      {"most_reach", &S::most_reach_m, 0, 1000, "m", "how far a path is followed"},
  };
  return fields;
}

const Fields<CycleSettings>& cycle_fields() {
  using S = CycleSettings;
  static const Fields<S> fields = {
      {"period_hz", &S::period_hz, 1, 1000, "Hz", "control cycles per second"},
      {"most_frames", &S::most_frames, 1, 4096, "", "CAN frames taken in one cycle; others wait"},
  };
  return fields;
}

const Fields<RealtimeSettings>& realtime_fields() {
  using S = RealtimeSettings;
  static const Fields<S> fields = {
      {"priority", &S::priority, 1, 99, "", "SCHED_FIFO priority of the control thread"},
      {"loader_priority", &S::loader_priority, 1, 98, "",
       "of the loader; must be below the control thread's"},
      {"cpu", &S::cpu, 0, 0, "", "number of the control thread's only processor; empty for any"},
      {"lock_memory", &S::lock_memory, 0, 0, "", "keep all pages in memory (mlockall)"},
  };
  return fields;
}

const Fields<RecorderSettings>& recorder_fields() {
  using S = RecorderSettings;
  static const Fields<S> fields = {
      {"bytes", &S::bytes, 0, kMost, "bytes",
       "of the newest inputs that the flight recorder of zoned run keeps, at least 2 MiB; 0: off"},
  };
  return fields;
}

const Fields<StateSettings>& state_fields() {
  using S = StateSettings;
  static const Fields<S> fields = {
      {"folder", &S::folder, 0, 0, "",
       "where pose and flight recorder survive a restart; empty: $STATE_DIRECTORY, else nowhere"},
  };
  return fields;
}

const Fields<GpioSettings>& gpio_fields() {
  using S = GpioSettings;
  static const Fields<S> fields = {
      {"heartbeat_period", &S::heartbeat_s, 0.02, 10, "s",
       "of the heartbeat's square wave, which goes on only while control cycles do and the other "
       "outputs could be set"},
  };
  return fields;
}

const Fields<OutputLine>& output_line_fields() {
  using S = OutputLine;
  static const Fields<S> fields = {
      {"chip", &S::chip, 0, 0, "", "label, name (gpiochip0) or file (/dev/gpiochip0); needed"},
      {"line", &S::line, 0, 0, "", "number or name; needed"},
      {"active_low", &S::active_low, 0, 0, "", "active is a low voltage"},
      {"safe", &S::safe, 0, 0, "",
       "while no zoned drives it, and from the start until it is known better; usual is active for "
       "fault, inactive for the others"},
  };
  return fields;
}

const Fields<InputLine>& input_line_fields() {
  using S = InputLine;
  static const Fields<S> fields = {
      {"chip", &S::chip, 0, 0, "", "as of an output; needed"},
      {"line", &S::line, 0, 0, "", "number or name; needed"},
      {"active_low", &S::active_low, 0, 0, "",
       "active is a low voltage, as of a contact to ground"},
      {"bias", &S::bias, 0, 0, "", "the chip's own resistor"},
      {"debounce", &S::debounce_s, 0, 10, "s", "a level counts once it has lasted so long"},
  };
  return fields;
}

const Fields<DockPlace>& dock_fields() {
  using S = DockPlace;
  static const Fields<S> fields = {
      {"x", &S::x_m, -1e6, 1e6, "m", "where base_link stands in the map when the contact closes"},
      {"y", &S::y_m, -1e6, 1e6, "m", "the same"},
      {"yaw", &S::yaw_rad, -7, 7, "rad", "the same"},
      {"sigma", &S::sigma_m, 1e-4, 10, "m", "how sure that is"},
      {"sigma_yaw", &S::sigma_rad, 1e-4, 3, "rad", "the same for the heading"},
  };
  return fields;
}

const Fields<MarkerPlace>& marker_fields() {
  using S = MarkerPlace;
  static const Fields<S> fields = {
      {"zones", &S::zones, 0, 0, "",
       "the two on the sides of the door that it marks, or the one that it lies in; needed"},
      {"reach", &S::reach_m, 0.01, 100, "m",
       "beside three sigma: believed when the pose is so near to the portal"},
  };
  return fields;
}

const Fields<ServeSettings>& serve_fields() {
  using S = ServeSettings;
  static const Fields<S> fields = {
      {"socket", &S::socket, 0, 0, "", "local socket for other programs; \"\" for none"},
      {"mode", &S::mode, 0, 0, "", "who may use it: octal digits, as chmod takes them"},
      {"looking_socket", &S::looking_socket, 0, 0, "",
       "a second one, through which nothing can be changed"},
      {"looking_mode", &S::looking_mode, 0, 0, "", "who may use that"},
      {"clients", &S::clients, 1, 1000, "", "programs connected at once"},
      {"requests", &S::requests_per_s, 1, 1e6, "1/s", "of each program; more of them wait"},
      {"lease", &S::lease_s, 0.01, 3600, "s", "how long a reader may hold a zone at a time"},
  };
  return fields;
}

}  // namespace zonepack
