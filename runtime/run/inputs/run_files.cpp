// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/inputs/run_files.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>
#include <string_view>

#include "platform/base/file_kind.hpp"
#include "platform/base/require.hpp"
#include "platform/base/utf8.hpp"
#include "runtime/odometry/det_math.hpp"
#include "runtime/run/figures/stamp_text.hpp"

namespace zonepack {
namespace {

constexpr std::string_view kCorrectionColumns =
    "stamp received x y yaw sigma_x sigma_y sigma_yaw [view]";
constexpr std::string_view kTruthColumns = "t x y z qx qy qz qw";

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t begin = 0;
  constexpr std::string_view kBetween = " \t\r,;";
  while ((begin = line.find_first_not_of(kBetween, begin)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBetween, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

Failure wrong_columns(std::span<const std::string_view> words) {
  return failure(std::to_string(words.size()) + " columns");
}

// Names of columns: no word is a number.
bool is_header(std::span<const std::string_view> words) {
  return std::none_of(words.begin(), words.end(), [](std::string_view word) {
    double value = 0;
    return parse_number(word, value);
  });
}

void ignore_names(std::span<const std::string_view>) {}

// Calls take(words) for every record; it fails with what is wrong with the line. The first two
// columns of a record may be stamps, so columns are words here. Calls names(words) for a first line
// of column names, which may begin with #.
template <typename Take, typename Names>
Outcome<void> for_each_record(const std::string& path, std::string_view columns, Take&& take,
                              Names&& names) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return failure(
        path + ": " + std::strerror(errno) + "; expected lines of " + std::string(columns),
        ErrorCode::kNotFound);
  }
  if (const std::string kind = stand_in_at(path); !kind.empty()) {
    return failure(path + ": is " + kind + "; expected lines of " + std::string(columns));
  }
  const std::vector<std::string_view> names_of_columns = split(columns);
  // Those in brackets may be absent.
  const auto count = static_cast<std::size_t>(
      std::count_if(names_of_columns.begin(), names_of_columns.end(),
                    [](std::string_view column) { return column.front() != '['; }));
  std::string line;
  bool first = true;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    std::string_view text = line;
    if (number == 1) text = without_byte_order_mark(text);
    const std::vector<std::string_view> words = split(text);
    if (words.empty()) continue;
    const bool header = first && is_header(words);
    if (header) names(std::span(words));
    if (words[0].front() == '#' || words[0].front() == '%') continue;
    first = false;
    if (header) continue;
    const Outcome<void> taken =
        words.size() < count ? wrong_columns(words) : take(std::span(words));
    if (taken) continue;
    return failure(path + ":" + std::to_string(number) + ": " + taken.error().message +
                   "; expected " + std::string(columns));
  }
  if (file.bad()) return failure(path + ": " + std::strerror(errno), ErrorCode::kIo);
  return {};
}

std::string in_quotes(std::string_view word) {
  return std::string(1, '"').append(word).append(1, '"');
}

// Reads words[first], words[first + 1] ... as numbers.
Outcome<void> parse_numbers(std::span<const std::string_view> words, std::size_t first,
                            std::span<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!parse_number(words[first + i], values[i])) {
      return failure(in_quotes(words[first + i]) + " is not a number");
    }
  }
  return {};
}

// The component that the columns' names put first in the quaternion: 'w' in EuRoC's "q_RS_w []".
// 0: they name none.
char first_of_quaternion(std::span<const std::string_view> names) {
  for (const std::string_view name : names) {
    const char last = name.back();
    const bool component = last >= 'w' && last <= 'z';
    if (component && name[0] == 'q' && (name.size() == 2 || name[1] == '_')) return last;
  }
  return 0;
}

// Whether a rotation with these x and y leans the robot's vertical axis by more than 60 degrees.
bool lies_down(double qx, double qy) { return 1 - 2 * (qx * qx + qy * qy) < 0.5; }

Failure not_a_stamp(std::string_view word) {
  return failure(in_quotes(word) + " is not a stamp in seconds");
}

}  // namespace

Outcome<std::vector<PoseCorrection>> read_corrections_as_written(const std::string& path) {
  std::vector<PoseCorrection> corrections;
  const auto take = [&](std::span<const std::string_view> words) -> Outcome<void> {
    if (words.size() != 8 && words.size() != 9) return wrong_columns(words);
    PoseCorrection c;
    if (!parse_stamp(words[0], c.stamp_ns)) return not_a_stamp(words[0]);
    if (!parse_stamp(words[1], c.received_ns)) return not_a_stamp(words[1]);
    double v[6] = {};
    if (auto numbers = parse_numbers(words, 2, v); !numbers) return numbers;
    c.T_map_base = {v[0], v[1], v[2]};
    c.sigma_x_m = v[3];
    c.sigma_y_m = v[4];
    c.sigma_yaw_rad = v[5];
    if (words.size() == 9) {
      if (auto view = parse_numbers(words, 8, {&c.view_m, 1}); !view) return view;
    }
    corrections.push_back(c);
    return {};
  };
  if (const auto read = for_each_record(path, kCorrectionColumns, take, ignore_names); !read)
    return read.error();
  return corrections;
}

Outcome<std::vector<PoseCorrection>> read_corrections(const std::string& path) {
  auto read = read_corrections_as_written(path);
  if (!read) return read;
  std::vector<PoseCorrection>& corrections = *read;
  std::stable_sort(corrections.begin(), corrections.end(),
                   [](const PoseCorrection& a, const PoseCorrection& b) {
                     return a.received_ns < b.received_ns;
                   });
  return read;
}

TruthTrack::TruthTrack(std::vector<Sample> samples) : samples_(std::move(samples)) {
  ZP_REQUIRE(!samples_.empty());
}

std::optional<Pose2> TruthTrack::at(std::int64_t t_ns) const noexcept {
  if (t_ns < samples_.front().t_ns || t_ns > samples_.back().t_ns) return std::nullopt;
  const auto after = std::lower_bound(samples_.begin(), samples_.end(), t_ns,
                                      [](const Sample& s, std::int64_t t) { return s.t_ns < t; });
  if (after->t_ns == t_ns) return after->T_map_base;
  const Sample& a = *(after - 1);
  const Sample& b = *after;
  const double part = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
  const Pose2& p = a.T_map_base;
  const Pose2& q = b.T_map_base;
  return Pose2{p.x_m + (q.x_m - p.x_m) * part, p.y_m + (q.y_m - p.y_m) * part,
               wrap_angle(p.yaw_rad + wrap_angle(q.yaw_rad - p.yaw_rad) * part)};
}

Outcome<TruthTrack> read_truth(const std::string& path) {
  std::vector<TruthTrack::Sample> samples;
  bool w_first = false;
  std::size_t lying = 0, lying_with_w_first = 0;
  const auto take = [&](std::span<const std::string_view> words) -> Outcome<void> {
    TruthTrack::Sample sample;
    if (!parse_stamp(words[0], sample.t_ns)) return not_a_stamp(words[0]);
    if (!samples.empty() && sample.t_ns < samples.back().t_ns) {
      return failure(
          "stamp " + std::string(words[0]) +
          " before the one on the line above; poses stand in order of "
          "time: sort -n puts them so, and where the clock was set back on the way, give the part "
          "after it as a drive of its own");
    }
    double v[7] = {};
    if (auto numbers = parse_numbers(words, 1, v); !numbers) return numbers;
    if (w_first) std::rotate(v + 3, v + 4, v + 7);
    const auto [x, y, z, qx, qy, qz, qw] = v;
    lying += lies_down(qx, qy) ? 1 : 0;
    lying_with_w_first += lies_down(qy, qz) ? 1 : 0;
    const double norm2 = qx * qx + qy * qy + qz * qz + qw * qw;
    if (!std::isfinite(x + y + z)) return failure("a position that is not finite");
    if (!(norm2 > 0.98 && norm2 < 1.02)) return failure("a quaternion that is not of length 1");
    const double yaw = det_atan2(2 * (qw * qz + qx * qy), norm2 - 2 * (qy * qy + qz * qz));
    sample.T_map_base = {x, y, yaw};
    samples.push_back(sample);
    return {};
  };
  const auto names = [&](std::span<const std::string_view> words) {
    w_first = first_of_quaternion(words) == 'w';
  };
  if (const auto read = for_each_record(path, kTruthColumns, take, names); !read) {
    return read.error();
  }
  if (samples.empty()) {
    return failure(path + ": no samples; expected lines of " + std::string(kTruthColumns));
  }
  if (!w_first && lying > samples.size() / 2 && lying_with_w_first == 0) {
    return failure(path +
                   ": the robot would lie on its side; the quaternions seem to be qw qx qy qz, "
                   "as EuRoC writes them: name the columns in a first line: # t x y z qw qx qy qz");
  }
  return TruthTrack(std::move(samples));
}

}  // namespace zonepack
