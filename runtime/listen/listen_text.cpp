// SPDX-License-Identifier: Apache-2.0
#include "runtime/listen/listen_text.hpp"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>

#include "platform/base/number_text.hpp"
#include "platform/base/utf8.hpp"
#include "runtime/odometry/det_math.hpp"

namespace zonepack {
namespace {

constexpr const char* kReset = "\x1b[0m";

using Cells = std::vector<std::string>;

std::string id_text(const CanId& id) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), id.extended ? "0x%08" PRIX32 : "0x%03" PRIX32, id.id);
  return text.data();
}

std::string raw_text(const ListenPicture::Row& row) {
  const SignalType type = row.signal->signal.type;
  const bool integer = type == SignalType::kSigned || type == SignalType::kUnsigned;
  return integer ? decimals_text(row.raw, 0) : short_number(row.raw, 7);
}

// As fine as the factor is, for a column that does not jump.
std::string value_text(const ListenPicture::Row& row) {
  const double factor = std::abs(row.signal->signal.factor);
  const int decimals =
      factor < 1 ? static_cast<int>(std::clamp(std::ceil(-std::log10(factor)), 1.0, 6.0)) : 0;
  const SignalType type = row.signal->signal.type;
  if (type == SignalType::kFloat || type == SignalType::kDouble) return short_number(row.value, 6);
  return decimals_text(row.value, factor == std::floor(factor) ? 0 : decimals);
}

const char* color_of(SignalState state) {
  if (state == SignalState::kFresh) return "\x1b[32m";
  return state == SignalState::kStale ? "\x1b[33m" : "\x1b[31m";
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::size_t used = utf8_width(text);
  const std::string blanks(width > used ? width - used : 0, ' ');
  return right ? blanks + text : text + blanks;
}

std::string table(const ListenPicture& picture, bool color) {
  constexpr std::array<bool, 9> kRight = {false, false, false, false, true,
                                          true,  false, true,  true};
  std::vector<Cells> lines = {
      {"key", "message", "id", "signal", "raw", "value", "unit", "Hz", "age s"}};
  for (const ListenPicture::Row& row : picture.rows) {
    const NamedSignal& s = *row.signal;
    const bool seen = row.count > 0;
    lines.push_back(
        {s.key.empty() ? "-" : s.key, s.message.empty() ? "-" : printable(s.message),
         id_text({s.signal.id, s.signal.extended}), printable(s.name), seen ? raw_text(row) : "-",
         seen ? value_text(row) : "-", s.unit.empty() ? "-" : printable(s.unit),
         seen ? decimals_text(row.rate_hz, 1) : "-", seen ? decimals_text(row.age_s, 2) : "-"});
  }
  std::array<std::size_t, kRight.size()> widths{};
  for (const Cells& cells : lines) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      widths[i] = std::max(widths[i], utf8_width(cells[i]));
    }
  }
  std::string text;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (std::size_t i = 0; i < kRight.size(); ++i) {
      text += padded(lines[n][i], widths[i], kRight[i]) + "  ";
    }
    if (n == 0) {
      text += "state\n";
      continue;
    }
    const SignalState state = picture.rows[n - 1].state;
    text += color ? color_of(state) + std::string(word_of(state)) + kReset : word_of(state);
    text += '\n';
  }
  return text;
}

std::string signed_text(double value, int decimals) {
  // What rounds to zero has no sign.
  const double step = std::pow(10.0, -decimals);
  if (std::abs(value) < step / 2) return decimals_text(0, decimals);
  return (value > 0 ? "+" : "") + decimals_text(value, decimals);
}

std::string wheels_line(const ListenPicture& picture) {
  std::string text;
  for (const ListenPicture::Row& row : picture.rows) {
    if (!row.signal->wheel) continue;
    text += (text.empty() ? "wheels    " : "   ") + row.signal->key + " ";
    if (row.count == 0) {
      text += "-";
      continue;
    }
    const bool moving = row.state != SignalState::kStale && row.state != SignalState::kUnreadable;
    text += signed_text(moving ? row.speed_m_s : 0, 2) + " m/s (" + signed_text(row.moved_m, 2) +
            " m so far)";
  }
  return text.empty() ? text : text + "\n";
}

std::string robot_lines(const ListenPicture& picture) {
  constexpr double kInDegrees = 180 / kPi;
  std::string text = "robot     ";
  if (picture.samples == 0) {
    text += "no step of odometry yet\n";
  } else {
    text += picture.stale ? "stale"
                          : signed_text(picture.speed_m_s, 2) + " m/s, " +
                                signed_text(picture.yaw_rate_rad_s * kInDegrees, 1) + " deg/s";
    text += "\nway       " + decimals_text(picture.distance_m, 2) + " m, turned " +
            signed_text(picture.heading_rad * kInDegrees, 1) + " deg; from the start x " +
            signed_text(picture.pose.x_m, 2) + " y " + signed_text(picture.pose.y_m, 2) + " m\n";
  }
  text += "samples   " + std::to_string(picture.samples) + " used, " +
          std::to_string(picture.refused) + " refused";
  return text + (picture.refused_why.empty() ? "" : ": " + picture.refused_why) + "\n";
}

std::string others_line(const ListenPicture& picture) {
  if (picture.others.empty()) return {};
  std::string text = "others    ";
  for (const ListenPicture::Other& other : picture.others) {
    if (text.back() != ' ') text += ", ";
    text += id_text(other.id);
    if (other.id.extended) text += " (29 bits)";
    if (!other.name.empty()) text += " " + printable(other.name);
    text += " " + decimals_text(other.rate_hz, 1) + " Hz";
  }
  if (picture.further_ids > 0) {
    text += " and " + std::to_string(picture.further_ids) + " further ids";
  }
  return text + ", which no setting names\n";
}

// What the hints rest on, so that silence can be judged.
std::string compared_line(const ListenPicture& picture, const ListenStyle& style) {
  if (!style.instruction.empty()) return {};
  if (picture.reference.empty()) {
    return "compare   with nothing: use --expect forward, then --expect left, or a log with "
           "--truth\n";
  }
  return "compare   with " + picture.reference + ": " + std::to_string(picture.compared) +
         " pieces of 2 s\n";
}

}  // namespace

std::string listen_text(const ListenPicture& picture, const ListenStyle& style) {
  std::string text = style.source + ": " + decimals_text(picture.seconds, 1) + " s, " +
                     std::to_string(picture.frames) + " frames";
  if (picture.error_frames > 0) {
    text += ", " + std::to_string(picture.error_frames) + " of them error frames";
  }
  text += "\n";
  if (!style.instruction.empty()) text += "expected  " + style.instruction + "\n";
  text += "\n" + table(picture, style.color) + "\n" + wheels_line(picture) + robot_lines(picture) +
          others_line(picture) + compared_line(picture, style);
  if (!style.note.empty()) text += "bus       " + style.note + "\n";
  for (const WheelHint& hint : picture.hints) text += hint_text(hint);
  return text;
}

std::string fitted(const std::string& text, int columns, int rows) {
  const auto wide = static_cast<std::size_t>(std::max(columns, 1));
  std::string fit;
  int row = 0;
  for (std::size_t from = 0; from < text.size() && row < rows;) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    std::size_t width = 0, at = from, blank = from;
    bool escape = false;  // colors take no column
    for (; at < end; ++at) {
      const char c = text[at];
      if (c == '\x1b') escape = true;
      if (!escape && !continues_utf8(c) && ++width > wide) break;
      if (escape && c == 'm') escape = false;
      if (c == ' ' && at > from) blank = at;
    }
    // A longer line goes on below, from its last blank if it has one.
    const std::size_t cut = at < end && blank > from ? blank : at;
    fit += text.substr(from, cut - from) + "\n";
    ++row;
    from = cut == end || (cut < end && text[cut] == ' ') ? cut + 1 : cut;
  }
  return fit;
}

}  // namespace zonepack
