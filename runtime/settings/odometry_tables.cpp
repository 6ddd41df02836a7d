// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/field.hpp"

namespace zonepack {

const Fields<CanSettings>& can_fields() {
  using S = CanSettings;
  static const Fields<S> fields = {
      {"interface", in<&S::interface>, 0, 0, "", "the bus whose frames are read; empty: any"},
      {"dbc", in<&S::dbc>, 0, 0, "",
       "DBC file; its signals are named MESSAGE.SIGNAL and come in addition to can.signals. "
       "MESSAGE@ID.SIGNAL where messages share a name"},
  };
  return fields;
}

const Fields<SignalText>& signal_fields() {
  using S = SignalText;
  static const Fields<S> fields = {
      {"id", in<&S::id>, 0, 0x1FFFFFFF, "", "CAN id; above 0x7FF only with extended: true"},
      {"extended", in<&S::extended>, 0, 0, "", "whether the id has 29 bits"},
      {"start", in<&S::start>, 0, 511, "",
       "DBC start bit: the lowest (little) or highest bit (big)"},
      {"length", in<&S::length>, 1, 64, "bits", "number of bits"},
      {"byte_order", in<&S::byte_order>, 0, 0, "", "little is Intel, big is Motorola"},
      {"type", in<&S::type>, 0, 0, "", "how the bits are read"},
      {"factor", in<&S::factor>, -kNoMost, kNoMost, "", "value = raw * factor + offset; not 0"},
      {"offset", in<&S::offset>, -kNoMost, kNoMost, "", "see factor"},
  };
  return fields;
}

const Fields<MultiplexText>& multiplex_fields() {
  using S = MultiplexText;
  static const Fields<S> fields = {
      {"start", in<&S::start>, 0, 511, "", "the same as for a signal"},
      {"length", in<&S::length>, 1, 64, "bits", "the same as for a signal"},
      {"byte_order", in<&S::byte_order>, 0, 0, "", "the same as for a signal"},
      {"value", in<&S::value>, 0, kNoMost, "",
       "the signal is present when the multiplexer has this value"},
  };
  return fields;
}

const Fields<CanOpenWatchSettings>& canopen_fields() {
  using S = CanOpenWatchSettings;
  static const Fields<S> fields = {
      {"heartbeat_timeout", in<&S::heartbeat_timeout_s>, 0.01, 60, "s",
       "a watched node that is silent for this long is lost: its data is refused and odometry goes "
       "stale"},
      {"sync_timeout", in<&S::sync_timeout_s>, 0, 60, "s",
       "the same for SYNC; 0: SYNC is not watched"},
      {"sync_id", in<&S::sync_id>, 1, 0x7FF, "", "CAN id of SYNC"},
  };
  return fields;
}

const Fields<CanOpenNodeText>& canopen_node_fields() {
  using S = CanOpenNodeText;
  static const Fields<S> fields = {
      {"node", in<&S::node>, 1, 127, "", "node id"},
      {"heartbeat", in<&S::heartbeat>, 0, 0, "",
       "whether its heartbeat is watched; the node must then be operational"},
      {"tpdo1", in<&S::tpdo1>, 0, 0, "",
       "mapped objects, as in object 0x1A00: [0x60410010, 0x60640020] makes the signals NAME.6041 "
       "and NAME.6064 (with another sub-index: NAME.2106sub1)"},
      {"tpdo2", in<&S::tpdo2>, 0, 0, "", "the same for 0x1A01"},
      {"tpdo3", in<&S::tpdo3>, 0, 0, "", "the same for 0x1A02"},
      {"tpdo4", in<&S::tpdo4>, 0, 0, "", "the same for 0x1A03"},
      {"tpdo1_id", in<&S::tpdo1_id>, 0, 0x7FF, "", "CAN id; 0 means 0x180 + node"},
      {"tpdo2_id", in<&S::tpdo2_id>, 0, 0x7FF, "", "CAN id; 0 means 0x280 + node"},
      {"tpdo3_id", in<&S::tpdo3_id>, 0, 0x7FF, "", "CAN id; 0 means 0x380 + node"},
      {"tpdo4_id", in<&S::tpdo4_id>, 0, 0x7FF, "", "CAN id; 0 means 0x480 + node"},
  };
  return fields;
}

const Fields<WheelGeometry>& geometry_fields() {
  using S = WheelGeometry;
  static const Fields<S> fields = {
      {"track", in<&S::track_m>, 0.01, 20, "m", "between left and right contact points"},
      {"slip_factor", in<&S::slip_factor>, 0.5, 10, "",
       "skid steering: how many times more the wheels turn than the track alone explains"},
      {"wheelbase", in<&S::wheelbase_m>, 0.01, 20, "m", "ackermann, mecanum: front to rear axle"},
      {"omni_radius", in<&S::omni_radius_m>, 0.01, 10, "m",
       "omni: from the robot's centre to each wheel"},
      {"omni_bearing", in<&S::omni_bearing_rad>, -7, 7, "rad",
       "omni: bearing of the first wheel from the centre; 0 is ahead"},
  };
  return fields;
}

const Fields<OdometrySettings>& odometry_fields() {
  using S = OdometrySettings;
  static const Fields<S> fields = {
      {"unit", in<&S::unit>, 0, 0, "",
       "unit of the wheel signals and of twist's forward speed (per second, for speeds). A unit "
       "that the DBC file gives (km/h, mph, deg/s, rpm ...) is converted; one that contradicts "
       "this key is refused"},
      {"angle_unit", in<&S::angle_unit>, 0, 0, "",
       "unit of steering and (per second) yaw_rate, where the DBC file gives none"},
      {"wheel_radius", in<&S::wheel_radius_m>, 0.001, 10, "m",
       "for every unit except metres, mm and km/h"},
      {"gear", in<&S::gear>, 0.0001, 100000, "",
       "turns of the motor, which the signals count, for one turn of the wheel"},
      {"pole_pairs", in<&S::pole_pairs>, 1, 1000, "", "pole pairs of the motor, for erpm"},
      {"ticks_per_turn", in<&S::ticks_per_turn>, 0, 1e12, "",
       "ticks of the encoder for one turn, for ticks"},
      {"full_scale", in<&S::full_scale>, 0, 1e9, "",
       "what 100 % is, in unit, for signals that the DBC file gives in %; 0: not given"},
      {"scale", in<&S::scale>, 0.5, 2, "",
       "true distance over reported distance; zoned calibrate estimates this key, scale_left, "
       "scale_right and track"},
      {"scale_left", in<&S::scale_left>, 0.5, 2, "", "the same for the wheels on the left only"},
      {"scale_right", in<&S::scale_right>, 0.5, 2, "", "the same for the wheels on the right only"},
      {"invert", in<&S::invert>, 0, 0, "",
       "keys of signals that count backwards: [right]; for omni wheels [\"1\", \"3\"]"},
      {"left", in<&S::left>, 0, 0, "",
       "signal of the left wheel: a name from can.signals, or MESSAGE.SIGNAL from can.dbc"},
      {"right", in<&S::right>, 0, 0, "", "signal of the right wheel"},
      {"forward", in<&S::forward>, 0, 0, "",
       "twist: signal of the forward speed; ackermann: signal of the driven axle, in unit"},
      {"yaw_rate", in<&S::yaw_rate>, 0, 0, "", "twist: signal of the yaw rate"},
      {"steering", in<&S::steering>, 0, 0, "",
       "ackermann: signal of the steering angle; left is positive"},
      {"front_left", in<&S::front_left>, 0, 0, "", "mecanum: signal of that wheel"},
      {"front_right", in<&S::front_right>, 0, 0, "", "the same"},
      {"rear_left", in<&S::rear_left>, 0, 0, "", "the same"},
      {"rear_right", in<&S::rear_right>, 0, 0, "", "the same"},
      {"around", in<&S::around>, 0, 0, "",
       "omni: signals of 3 or 4 wheels evenly around the centre, counter-clockwise"},
  };
  return fields;
}

const Fields<WheelOdometrySettings>& wheel_fields() {
  using S = WheelOdometrySettings;
  static const Fields<S> fields = {
      {"model", in<&S::model>, 0, 0, "", "what the signals measure"},
      {"steering_offset", in<&S::steering_offset_rad>, -3, 3, "rad",
       "ackermann: added to the steering angle"},
      {"max_speed", in<&S::max_speed_m_s>, 0.01, 100, "m/s", "a faster sample is refused"},
      {"max_yaw_rate", in<&S::max_yaw_rate_rad_s>, 0.01, 100, "rad/s", "the same for turning"},
      {"max_acceleration", in<&S::max_acceleration_m_s2>, 0.1, 1000, "m/s2",
       "the same for a wheel's acceleration between samples"},
      {"gap", in<&S::gap_s>, 0.01, 60, "s", "a longer pause between samples is a gap"},
      {"timeout", in<&S::timeout_s>, 0.01, 60, "s",
       "after this long without samples, uncertainty grows. If absent, and can.dbc gives "
       "GenMsgCycleTime: 3 times the longest of the messages read, at least two cycles"},
      {"sigma_forward_per_sqrt_m", in<&S::sigma_forward_per_sqrt_m>, 0, 10, "m",
       "noise of 1 m of way: along it"},
      {"sigma_sideways_per_sqrt_m", in<&S::sigma_sideways_per_sqrt_m>, 0, 10, "m",
       "noise of 1 m of way: across it (slip)"},
      {"sigma_yaw_per_sqrt_m", in<&S::sigma_yaw_per_sqrt_m>, 0, 10, "rad",
       "noise of 1 m of way: heading"},
      {"sigma_forward_per_sqrt_rad", in<&S::sigma_forward_per_sqrt_rad>, 0, 10, "m",
       "noise of a turn by 1 rad: along the way"},
      {"sigma_yaw_per_sqrt_rad", in<&S::sigma_yaw_per_sqrt_rad>, 0, 10, "rad",
       "noise of a turn by 1 rad: heading"},
      {"sigma_gap_per_m", in<&S::sigma_gap_per_m>, 0, 10, "",
       "positions: how far off the end of a gap may be, as a share of its length"},
      {"sigma_gap_per_s", in<&S::sigma_gap_m_per_s>, 0, 100, "m/s",
       "speeds, and positions that jumped: distance that may be missing, for each second of a gap"},
      {"sigma_gap_yaw_per_s", in<&S::sigma_gap_rad_per_s>, 0, 100, "rad/s",
       "the same for the heading"},
  };
  return fields;
}

}  // namespace zonepack
