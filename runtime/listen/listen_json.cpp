// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "platform/base/json_text.hpp"
#include "platform/base/number_text.hpp"
#include "runtime/listen/listen_text.hpp"

namespace zonepack {
namespace {

std::string number(double value, int decimals) {
  return std::isfinite(value) ? decimals_text(value, decimals) : "null";
}

// Any double, so that none is lost to rounding.
std::string exact(double value) { return std::isfinite(value) ? short_number(value, 17) : "null"; }

std::string quoted(const std::string& text) { return json_quoted(printable(text)); }

std::string json_of(const CanId& id) {
  return "\"id\": " + std::to_string(id.id) + ", \"extended\": " + (id.extended ? "true" : "false");
}

std::string json_of(const ListenPicture::Row& row) {
  const NamedSignal& s = *row.signal;
  const bool seen = row.count > 0;
  const auto value = [seen](const std::string& text) { return seen ? text : "null"; };
  std::string text =
      "    {\"key\": " + quoted(s.key) + ", \"message\": " + quoted(s.message) + ", " +
      json_of(CanId{s.signal.id, s.signal.extended}) + ", \"signal\": " + quoted(s.name) +
      ", \"unit\": " + quoted(s.unit) + ", \"raw\": " + value(exact(row.raw)) +
      ", \"value\": " + value(exact(row.value)) + ", \"least\": " + value(exact(row.least_seen)) +
      ", \"most\": " + value(exact(row.most_seen)) + ", \"count\": " + std::to_string(row.count) +
      ", \"rate_hz\": " + value(number(row.rate_hz, 3)) +
      ", \"age_s\": " + value(number(row.age_s, 3)) +
      ", \"state\": " + json_quoted(word_of(row.state));
  if (s.wheel) {
    text += ", \"speed_m_s\": " + value(number(row.speed_m_s, 4)) +
            ", \"moved_m\": " + value(number(row.moved_m, 4));
  }
  return text + "}";
}

std::string json_of(const ListenPicture::Other& other) {
  return "    {" + json_of(other.id) + ", \"message\": " + quoted(other.name) +
         ", \"count\": " + std::to_string(other.count) +
         ", \"rate_hz\": " + number(other.rate_hz, 3) + "}";
}

template <typename Items>
std::string json_array(const char* name, const Items& items) {
  std::string text = "  \"" + std::string(name) + "\": [";
  bool first = true;
  for (const auto& item : items) {
    text += (first ? "\n" : ",\n") + json_of(item);
    first = false;
  }
  return text + (first ? "]" : "\n  ]");
}

}  // namespace

std::string listen_json(const ListenPicture& p, const std::string& source,
                        const std::string& mismatch) {
  return "{\n  \"source\": " + quoted(source) + ",\n  \"seconds\": " + number(p.seconds, 3) +
         ",\n  \"frames\": " + std::to_string(p.frames) +
         ",\n  \"error_frames\": " + std::to_string(p.error_frames) + ",\n" +
         json_array("signals", p.rows) +
         ",\n  \"robot\": {\"speed_m_s\": " + number(p.speed_m_s, 4) +
         ", \"yaw_rate_rad_s\": " + number(p.yaw_rate_rad_s, 4) +
         ", \"distance_m\": " + number(p.distance_m, 4) +
         ", \"heading_rad\": " + number(p.heading_rad, 4) + ", \"x_m\": " + number(p.pose.x_m, 4) +
         ", \"y_m\": " + number(p.pose.y_m, 4) + ", \"stale\": " + (p.stale ? "true" : "false") +
         "},\n  \"samples\": " + std::to_string(p.samples) +
         ",\n  \"refused\": " + std::to_string(p.refused) +
         ",\n  \"refused_why\": " + quoted(p.refused_why) + ",\n" + json_array("others", p.others) +
         ",\n  \"further_ids\": " + std::to_string(p.further_ids) +
         ",\n  \"compared_with\": " + quoted(p.reference) +
         ",\n  \"compared_windows\": " + std::to_string(p.compared) +
         ",\n  \"mismatch\": " + quoted(mismatch) + ",\n  \"hints\": " + hints_json(p.hints) +
         "\n}\n";
}

}  // namespace zonepack
