// SPDX-License-Identifier: Apache-2.0
#include "packer/align/trajectory.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "platform/base/file_kind.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLongestFile = std::uintmax_t{256} << 20;
constexpr double kLongestGap_s = 1;

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r'; }

// How many numbers a line begins with, at most eight, and whether nothing else follows.
struct Numbers {
  std::array<double, 8> values{};
  std::size_t count = 0;
  bool whole = true;
};

Numbers numbers_in(std::string_view line) {
  Numbers found;
  while (true) {
    while (!line.empty() && is_separator(line.front())) line.remove_prefix(1);
    if (line.empty()) return found;
    if (found.count == found.values.size()) break;
    double& value = found.values[found.count];
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error != std::errc() || !std::isfinite(value)) break;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    if (!line.empty() && !is_separator(line.front())) break;
    ++found.count;
  }
  found.whole = false;
  return found;
}

void require_text_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    throw std::runtime_error(file.string() + ": no such file; expected a trajectory (TUM)");
  }
  if (const std::string kind = misplaced_at(file.string(), {}); !kind.empty()) {
    throw std::runtime_error(file.string() + ": " + kind + "; expected a trajectory (TUM)");
  }
  if (fs::file_size(file, error) > kLongestFile && !error) {
    throw std::runtime_error(file.string() + ": is longer than 256 MiB; thin the trajectory out");
  }
}

}  // namespace

Trajectory Trajectory::read(const fs::path& file) {
  require_text_file(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read: " + std::strerror(errno));
  Trajectory out;
  std::string line;
  bool titled = false;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    std::string_view text = line;
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty() && is_separator(text.front())) text.remove_prefix(1);
    if (text.empty() || text.front() == '#') continue;
    const auto refuse = [&](const std::string& problem) {
      throw std::runtime_error(file.string() + ", line " + std::to_string(number) + ": " + problem);
    };
    const Numbers n = numbers_in(text);
    if (n.count == 0 && out.poses_.empty() && !titled) {
      titled = true;
      continue;
    }
    if (n.count != 8 || !n.whole) {
      refuse("expected 8 numbers, stamp x y z qx qy qz qw, found " +
             (n.whole ? std::to_string(n.count) : "'" + std::string(text.substr(0, 60)) + "'"));
    }
    const auto& v = n.values;
    const double stamp = v[0] > 1e17 ? v[0] * 1e-9 : v[0];  // nanoseconds since 1970
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    if (q.norm() < 1e-3) refuse("expected a rotation qx qy qz qw, found one of no length");
    if (!out.poses_.empty() && stamp <= out.poses_.back().stamp_s) {
      refuse("expected stamps that ascend, found one that is not later than the line before");
    }
    StampedPose& pose = out.poses_.emplace_back();
    pose.stamp_s = stamp;
    pose.T_frame_base = Eigen::Translation3d(v[1], v[2], v[3]) * q.normalized();
  }
  if (out.poses_.empty()) {
    throw std::runtime_error(file.string() +
                             ": holds no pose; expected lines of stamp x y z qx qy qz qw");
  }
  return out;
}

std::optional<Eigen::Isometry3d> Trajectory::at(double stamp_s) const {
  const auto after = std::ranges::lower_bound(poses_, stamp_s, {}, &StampedPose::stamp_s);
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp_s == stamp_s) return after->T_frame_base;
  if (after == poses_.begin()) return std::nullopt;
  const StampedPose& a = *std::prev(after);
  const double gap = after->stamp_s - a.stamp_s;
  if (gap > kLongestGap_s) return std::nullopt;
  const double share = (stamp_s - a.stamp_s) / gap;
  const Eigen::Quaterniond from(a.T_frame_base.linear()), to(after->T_frame_base.linear());
  const Eigen::Vector3d p =
      a.T_frame_base.translation() * (1 - share) + after->T_frame_base.translation() * share;
  return Eigen::Isometry3d(Eigen::Translation3d(p) * from.slerp(share, to));
}

}  // namespace zonepack::packer
