// SPDX-License-Identifier: Apache-2.0
#include "packer/tune/driven_path.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "platform/base/file_kind.hpp"
#include "platform/base/utf8.hpp"

namespace zonepack::packer::tune {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLongestFile = std::uintmax_t{256} << 20;
constexpr std::size_t kMostNumbers = 16;
constexpr double kFarthest_m = 1e6;
constexpr double kUnitQuaternion = 0.01;  // how far the length of a rotation may be off 1
constexpr double kLatest_s = 60;          // a fix is received so long after its stamp, at most
constexpr double kFixSpread_m = 0.6;      // between two right fixes of a robot that stands ...
constexpr double kFastest_m_s = 1.5;      // ... and so much more for each second between them
constexpr char kExpected[] =
    "expected a path, stamp x y z qx qy qz qw, or fixes, stamp received x y yaw";

struct Row {
  std::size_t line = 0;
  std::size_t count = 0;
  std::array<double, kMostNumbers> values{};
};

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r'; }

// The numbers of a line; nothing when it holds anything else.
std::optional<Row> row_of(std::string_view text) {
  Row row;
  while (true) {
    while (!text.empty() && is_separator(text.front())) text.remove_prefix(1);
    if (text.empty()) return row;
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && !is_separator(text.front())) return std::nullopt;
    if (row.count < kMostNumbers) row.values[row.count++] = value;
  }
}

double seconds(double stamp) { return stamp > 1e17 ? stamp * 1e-9 : stamp; }

bool has_rotation(const Row& row) {
  if (row.count < 8) return false;
  const auto& v = row.values;
  const double length = std::sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7]);
  return std::abs(length - 1) <= kUnitQuaternion;
}

bool is_fix(const Row& row) {
  if (row.count < 5) return false;
  const double delay = seconds(row.values[1]) - seconds(row.values[0]);
  return delay >= 0 && delay <= kLatest_s && std::abs(row.values[4]) < 10;
}

bool agree(const DrivePose& a, const DrivePose& b) {
  return distance_m(a.p_map, b.p_map) <= kFixSpread_m + kFastest_m_s * std::max(0.0, b.t_s - a.t_s);
}

// A fix stays that agrees with the last one kept, or with one of the next two.
void leave_out_wrong_fixes(DrivenPath& drive) {
  std::vector<DrivePose> kept;
  for (std::size_t i = 0; i < drive.poses.size(); ++i) {
    const DrivePose& pose = drive.poses[i];
    const bool with_last = !kept.empty() && agree(kept.back(), pose);
    bool with_next = false;
    for (std::size_t next = i + 1; next < drive.poses.size() && next <= i + 2; ++next) {
      with_next = with_next || agree(pose, drive.poses[next]);
    }
    if (with_last || with_next || drive.poses.size() == 1) {
      kept.push_back(pose);
    } else {
      ++drive.left_out;
    }
  }
  drive.poses = std::move(kept);
}

[[noreturn]] void refuse(const std::string& file, std::size_t line, const std::string& problem) {
  throw std::runtime_error(file + ", line " + std::to_string(line) + ": " + problem);
}

// Of a line for a message, without half a character at its end.
std::string start_of(std::string_view line) {
  std::size_t end = std::min<std::size_t>(line.size(), 60);
  while (end > 0 && end < line.size() && continues_utf8(line[end])) --end;
  return std::string(line.substr(0, end));
}

std::vector<Row> rows_of(const std::string& text, const std::string& file) {
  std::vector<Row> rows;
  std::istringstream in(text);
  bool titled = false;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    std::string_view words = line;
    if (number == 1 && words.starts_with("\xEF\xBB\xBF")) words.remove_prefix(3);
    while (!words.empty() && is_separator(words.front())) words.remove_prefix(1);
    if (words.empty() || words.front() == '#') continue;
    std::optional<Row> row = row_of(words);
    if (!row && rows.empty() && !titled && words.front() != '(') {
      titled = true;
      continue;
    }
    if (!row) {
      if (!is_utf8(words)) refuse(file, number, std::string("is no text; ") + kExpected);
      const std::string found = start_of(words);
      refuse(file, number,
             words.front() == '('
                 ? "'" + found + "' is of a CAN log, which holds turns of wheels and no places; " +
                       kExpected
                 : std::string(kExpected) + ", found '" + found + "'");
    }
    row->line = number;
    rows.push_back(*row);
  }
  if (rows.empty()) throw std::runtime_error(file + ": holds no pose; " + kExpected);
  return rows;
}

}  // namespace

DrivenPath parse_driven_path(const std::string& text, const std::string& file) {
  const std::vector<Row> rows = rows_of(text, file);
  DrivenPath drive{.file = file, .fixes = false, .poses = {}, .left_out = 0};
  const Row& first = rows.front();
  if (!has_rotation(first)) {
    if (!is_fix(first)) {
      refuse(file, first.line,
             std::string("is neither a path nor fixes; ") + kExpected + ", found " +
                 std::to_string(first.count) + (first.count == 1 ? " number" : " numbers") +
                 (first.count >= 8 ? ", of which the fifth to eighth are no rotation and the "
                                     "second is no stamp"
                                   : ""));
    }
    drive.fixes = true;
  }
  for (const Row& row : rows) {
    const auto& v = row.values;
    if (drive.fixes ? !is_fix(row) : !has_rotation(row)) {
      refuse(file, row.line,
             drive.fixes ? "expected a fix like those before, stamp received x y yaw, received at "
                           "or at most a minute after its stamp"
                         : "expected a pose like those before, stamp x y z qx qy qz qw with a "
                           "rotation of length 1");
    }
    DrivePose pose;
    pose.t_s = seconds(v[0]);
    pose.p_map = drive.fixes ? Point2{v[2], v[3]} : Point2{v[1], v[2]};
    pose.z_map_m = drive.fixes ? 0 : v[3];
    if (std::max(std::abs(pose.p_map.x_m), std::abs(pose.p_map.y_m)) > kFarthest_m) {
      refuse(file, row.line, "the place is over 1,000 km off; expected metres of the map's frame");
    }
    if (!drive.fixes && !drive.poses.empty() && pose.t_s < drive.poses.back().t_s) {
      refuse(file, row.line, "expected stamps that ascend, found one before that of the last line");
    }
    drive.poses.push_back(pose);
  }
  if (drive.fixes) {
    std::ranges::stable_sort(drive.poses, {}, &DrivePose::t_s);
    leave_out_wrong_fixes(drive);
    if (drive.poses.empty()) {
      throw std::runtime_error(file + ": no two fixes in a row agree with how fast a robot drives");
    }
  }
  return drive;
}

DrivenPath read_driven_path(const std::string& file) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    throw std::runtime_error(file + ": no such file; " + kExpected);
  }
  if (const std::string kind = misplaced_at(file, {}); !kind.empty()) {
    throw std::runtime_error(file + ": " + kind + "; " + kExpected);
  }
  if (fs::file_size(file, error) > kLongestFile && !error) {
    throw std::runtime_error(file + ": is longer than 256 MiB; thin it out");
  }
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in && in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
  if (!in) throw std::runtime_error(file + ": cannot be read: " + std::strerror(errno));
  return parse_driven_path(std::move(text).str(), file);
}

}  // namespace zonepack::packer::tune
