// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/field.hpp"

namespace zonepack {

const Fields<MapSettings>& map_fields() {
  using S = MapSettings;
  static const Fields<S> fields = {
      {"path", in<&S::path>, 0, 0, "", "folder of the map; --map replaces it"},
  };
  return fields;
}

const Fields<MemorySettings>& memory_fields() {
  using S = MemorySettings;
  static const Fields<S> fields = {
      {"budget", in<&S::budget>, 0, 0, "",
       "hard limit of all memory that grows with the map; --budget"},
      {"max_signatures", in<&S::max_signatures>, 0, kNoMost, "signatures",
       "most signatures in memory at once; 0: no limit; --max-signatures"},
      {"payload", in<&S::payload>, 0, 0, "",
       "what is loaded of every signature besides its core (pose and links)"},
      {"eviction", in<&S::eviction>, 0, 0, "",
       "which zone makes room: lru, the least recently used; expected, the one expected to be used "
       "last, by the route and by preload.transitions and preload.learn"},
      {"pinned", in<&S::pinned>, 0, 0, "", "names of zones that are never unloaded"},
      {"layers", in<&S::layers>, 0, 0, "",
       "names of layers (zonepack build --layer): zones of others are never loaded; []: all"},
  };
  return fields;
}

const Fields<LoadingSettings>& loading_fields() {
  using S = LoadingSettings;
  static const Fields<S> fields = {
      {"read", in<&S::read>, 0, 0, "",
       "direct: past the page cache, several requests at once (buffered where the file system "
       "has no such reads); mapped: from mapped windows; buffered: through the page cache. None "
       "leaves more than 4 MiB in the cache"},
      {"rate_limit", in<&S::rate_limit>, 0, 1e12, "bytes/s",
       "most that is read from packs in a second; 0: no limit"},
      {"storage_rate", in<&S::storage_rate>, 1000, 1e12, "bytes/s",
       "how fast packs are read; --storage-rate"},
      {"decode_rate", in<&S::decode_rate>, 1000, 1e12, "bytes/s",
       "how fast they are decoded, in decoded bytes"},
  };
  return fields;
}

const Fields<PoseFilterSettings>& pose_fields() {
  using S = PoseFilterSettings;
  static const Fields<S> fields = {
      {"gate", in<&S::gate_chi2>, 1, 1000, "",
       "squared Mahalanobis distance up to which a fix is accepted; chi-squared with 3 degrees of "
       "freedom: 16.27 is 99.9 %"},
      {"history", in<&S::history_s>, 0.1, 60, "s", "how late a fix may arrive"},
      {"history_step", in<&S::history_step_s>, 0.001, 1, "s",
       "odometry steps shorter than this share an entry of the history"},
      {"future_tolerance", in<&S::future_tolerance_s>, 0, 10, "s",
       "how far in the future a fix may be stamped"},
      {"min_sigma", in<&S::min_sigma_m>, 1e-6, 10, "m", "no fix counts as more accurate than this"},
      {"min_sigma_yaw", in<&S::min_sigma_rad>, 1e-6, 3, "rad", "the same for the heading"},
      {"reinit_fixes", in<&S::reinit_fixes>, 2, 100, "",
       "rejected fixes in a row that agree with each other, and then move the pose"},
      {"start_sigma", in<&S::start_sigma_m>, 0.001, 1000, "m",
       "uncertainty of a start pose that is given"},
      {"start_sigma_yaw", in<&S::start_sigma_rad>, 0.001, 10, "rad", "the same for the heading"},
      {"drift_sigma_per_sqrt_s", in<&S::drift_sigma_m_per_sqrt_s>, 0, 100, "m",
       "growth of the uncertainty in 1 s without odometry"},
      {"drift_sigma_yaw_per_sqrt_s", in<&S::drift_sigma_rad_per_sqrt_s>, 0, 100, "rad",
       "the same for the heading"},
      {"speed_filter", in<&S::speed_filter_s>, 0, 10, "s", "time constant of the speed filter"},
      {"extrapolate", in<&S::extrapolate_s>, 0, 1, "s",
       "how far the newest odometry is extrapolated to the present"},
  };
  return fields;
}

const Fields<TrackerSettings>& zones_fields() {
  using S = TrackerSettings;
  static const Fields<S> fields = {
      {"least_depth", in<&S::least_depth_m>, 0, 10, "m",
       "how deep in a neighbouring zone the pose must be: one sigma, but at least this ..."},
      {"most_depth", in<&S::most_depth_m>, 0, 10, "m", "... and at most this"},
      {"wall_depth", in<&S::wall_depth_m>, 0, 10, "m",
       "where no portal leads: this plus three sigma"},
      {"start_radius", in<&S::start_radius_m>, 0, 100, "m",
       "a pose outside every zone starts in the nearest one within this plus three sigma"},
  };
  return fields;
}

const Fields<PreloadSettings>& preload_fields() {
  using S = PreloadSettings;
  static const Fields<S> fields = {
      {"margin", in<&S::margin_m>, 0, 10, "m",
       "how far ahead a zone must be ready, in addition to three sigma"},
      {"motion_average", in<&S::motion_average_s>, 0, 10, "s",
       "time over which the motion is smoothed"},
      {"standing", in<&S::standing_m_s>, 0, 10, "m/s", "slower than this counts as standing"},
      {"hold", in<&S::hold_s>, 0, 60, "s",
       "an approach that is not seen for this long is given up"},
      {"most_turn", in<&S::most_turn_rad>, 0, 6.3, "rad",
       "how far the present arc is followed; then the path goes on straight"},
      {"most_reach", in<&S::most_reach_m>, 0, 1000, "m", "how far any path is followed"},
      {"transitions", in<&S::transitions>, 0, 0, "",
       "file of what zoned learn counted, by which zones are loaded that are likely to come; "
       "empty: none"},
      {"learn", in<&S::learn>, 0, 0, "",
       "go on counting while the robot drives; kept in state.folder; without transitions it begins "
       "with nothing"},
      {"pays", in<&S::pays>, 0, 100, "",
       "a likely zone is loaded when that saves so many seconds of waiting for each second of "
       "reading that may be for nothing"},
  };
  return fields;
}

const Fields<CycleSettings>& cycle_fields() {
  using S = CycleSettings;
  static const Fields<S> fields = {
      {"period_hz", in<&S::period_hz>, 1, 1000, "Hz", "control cycles per second"},
      {"most_frames", in<&S::most_frames>, 1, 4096, "",
       "CAN frames taken in one cycle; the others wait"},
  };
  return fields;
}

const Fields<RealtimeSettings>& realtime_fields() {
  using S = RealtimeSettings;
  static const Fields<S> fields = {
      {"priority", in<&S::priority>, 1, 99, "", "SCHED_FIFO priority of the control thread"},
      {"loader_priority", in<&S::loader_priority>, 1, 98, "",
       "the same for the loader; must be below priority"},
      {"cpu", in<&S::cpu>, 0, 0, "",
       "number of the only processor that the control thread may use; empty: any"},
      {"lock_memory", in<&S::lock_memory>, 0, 0, "", "whether all pages stay in memory (mlockall)"},
  };
  return fields;
}

const Fields<RecorderSettings>& recorder_fields() {
  using S = RecorderSettings;
  static const Fields<S> fields = {
      {"bytes", in<&S::bytes>, 0, kNoMost, "bytes",
       "how much of the newest inputs is kept, with the maps that they need, at least 2 MiB; 0: "
       "off"},
  };
  return fields;
}

const Fields<StateSettings>& state_fields() {
  using S = StateSettings;
  static const Fields<S> fields = {
      {"folder", in<&S::folder>, 0, 0, "",
       "folder of the pose and the flight recorder; empty: $STATE_DIRECTORY, or nowhere without "
       "it"},
  };
  return fields;
}

const Fields<GpioSettings>& gpio_fields() {
  using S = GpioSettings;
  static const Fields<S> fields = {
      {"heartbeat_period", in<&S::heartbeat_s>, 0.02, 10, "s",
       "period of the square wave of heartbeat, which goes on only while control cycles run and "
       "the other "
       "outputs can be set"},
  };
  return fields;
}

const Fields<OutputLine>& output_line_fields() {
  using S = OutputLine;
  static const Fields<S> fields = {
      {"chip", in<&S::chip>, 0, 0, "",
       "label, name (gpiochip0) or file (/dev/gpiochip0); required"},
      {"line", in<&S::line>, 0, 0, "", "number or name; required"},
      {"active_low", in<&S::active_low>, 0, 0, "", "whether a low voltage means active"},
      {"safe", in<&S::safe>, 0, 0, "",
       "the level while no zoned drives the line, and at the start until the state is known; "
       "usual: "
       "active for fault, inactive for the others"},
  };
  return fields;
}

const Fields<InputLine>& input_line_fields() {
  using S = InputLine;
  static const Fields<S> fields = {
      {"chip", in<&S::chip>, 0, 0, "", "the same as for an output; required"},
      {"line", in<&S::line>, 0, 0, "", "number or name; required"},
      {"active_low", in<&S::active_low>, 0, 0, "",
       "whether a low voltage means active, as with a contact to ground"},
      {"bias", in<&S::bias>, 0, 0, "", "the chip's own resistor"},
      {"debounce", in<&S::debounce_s>, 0, 10, "s", "a level counts once it has lasted this long"},
  };
  return fields;
}

const Fields<DockPlace>& dock_fields() {
  using S = DockPlace;
  static const Fields<S> fields = {
      {"x", in<&S::x_m>, -1e6, 1e6, "m", "where base_link is in the map when the contact closes"},
      {"y", in<&S::y_m>, -1e6, 1e6, "m", "the same"},
      {"yaw", in<&S::yaw_rad>, -7, 7, "rad", "the same"},
      {"sigma", in<&S::sigma_m>, 1e-4, 10, "m", "uncertainty of that position"},
      {"sigma_yaw", in<&S::sigma_rad>, 1e-4, 3, "rad", "the same for the heading"},
  };
  return fields;
}

const Fields<MarkerPlace>& marker_fields() {
  using S = MarkerPlace;
  static const Fields<S> fields = {
      {"zones", in<&S::zones>, 0, 0, "",
       "the two zones on either side of the marked door, or the one zone that holds the beacon; "
       "required"},
      {"reach", in<&S::reach_m>, 0.01, 100, "m",
       "the marker is believed if the pose is within this plus three sigma of the portal"},
  };
  return fields;
}

const Fields<ServeSettings>& serve_fields() {
  using S = ServeSettings;
  static const Fields<S> fields = {
      {"socket", in<&S::socket>, 0, 0, "",
       "local socket for other programs; auto: /run/zoned/zoned.sock, and "
       "$XDG_RUNTIME_DIR/zonepack/zoned.sock for a user other than root who has one; \"\": none; "
       "--socket"},
      {"mode", in<&S::mode>, 0, 0, "",
       "mode of the socket file, in octal as for chmod: who may use it"},
      {"group", in<&S::group>, 0, 0, "",
       "group of the socket files, by its name; zoned's user must be in it; empty: its own"},
      {"looking_socket", in<&S::looking_socket>, 0, 0, "",
       "a second socket, through which nothing can be changed; empty: none"},
      {"looking_mode", in<&S::looking_mode>, 0, 0, "", "mode of that socket file"},
      {"clients", in<&S::clients>, 1, 1000, "", "most programs connected at once"},
      {"requests", in<&S::requests_per_s>, 1, 1e6, "a second",
       "most requests of one program; further ones wait"},
      {"lease", in<&S::lease_s>, 0.01, 3600, "s",
       "how long a reader may hold a zone before it must ask again"},
  };
  return fields;
}

}  // namespace zonepack
