// SPDX-License-Identifier: Apache-2.0
#include "packer/align/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
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

constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{256} << 20;
constexpr std::size_t kColumns = 8;
constexpr std::string_view kBlanks = " \t\r";

[[noreturn]] void refuse(const std::filesystem::path& path, std::size_t line,
                         const std::string& what) {
  throw std::runtime_error(path.string() + ":" + std::to_string(line) + ": " + what +
                           "; expected a TUM trajectory, 'stamp x y z qx qy qz qw' a line, in "
                           "seconds and metres");
}

TimedPosition read_line(std::string_view text, const std::filesystem::path& path,
                        std::size_t line) {
  std::array<double, kColumns> values{};
  std::size_t count = 0;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (text.empty()) break;
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    if (count == kColumns) refuse(path, line, "more than 8 numbers");
    const auto read = std::from_chars(word.data(), word.data() + word.size(), values[count]);
    if (read.ec != std::errc() || read.ptr != word.data() + word.size()) {
      refuse(path, line, "'" + std::string(word.substr(0, 32)) + "' is no number");
    }
    if (!std::isfinite(values[count])) {
      refuse(path, line, "'" + std::string(word.substr(0, 32)) + "' is not finite");
    }
    ++count;
  }
  if (count != kColumns) refuse(path, line, std::to_string(count) + " numbers");
  return {values[0], {values[1], values[2], values[3]}};
}

}  // namespace

Trajectory Trajectory::read(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    throw std::runtime_error(path.string() + ": is a folder, expected a TUM trajectory");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kMostFileBytes) {
    throw std::runtime_error(path.string() + ": is " + std::to_string(size) +
                             " bytes long, a trajectory has at most " +
                             std::to_string(kMostFileBytes));
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw std::runtime_error(path.string() +
                             ": cannot read the trajectory: " + std::strerror(errno));
  }
  std::vector<TimedPosition> positions;
  std::string text;
  for (std::size_t line = 1; std::getline(file, text); ++line) {
    if (line == 1) {
      if (const std::string kind = stand_in(text, path.string()); !kind.empty()) {
        throw std::runtime_error(path.string() + ": is " + kind + "; expected a TUM trajectory");
      }
    }
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string::npos || text[begin] == '#') continue;
    positions.push_back(read_line(text, path, line));
  }
  if (file.bad()) {
    throw std::runtime_error(path.string() + ": cannot be read to its end");
  }
  if (positions.empty()) {
    throw std::runtime_error(path.string() +
                             ": holds no pose; expected a TUM trajectory, 'stamp x "
                             "y z qx qy qz qw' a line");
  }
  return Trajectory(std::move(positions));
}

Trajectory::Trajectory(std::vector<TimedPosition> positions) : positions_(std::move(positions)) {
  std::stable_sort(
      positions_.begin(), positions_.end(),
      [](const TimedPosition& a, const TimedPosition& b) { return a.stamp < b.stamp; });
}

std::optional<Point3> Trajectory::at(double stamp, double tolerance_s) const {
  const auto after = std::lower_bound(
      positions_.begin(), positions_.end(), stamp,
      [](const TimedPosition& position, double wanted) { return position.stamp < wanted; });
  const TimedPosition* nearest = after == positions_.end() ? nullptr : &*after;
  if (after != positions_.begin()) {
    const TimedPosition& before = *std::prev(after);
    if (nearest == nullptr || stamp - before.stamp < nearest->stamp - stamp) nearest = &before;
  }
  if (nearest == nullptr || !(std::abs(nearest->stamp - stamp) <= tolerance_s)) return std::nullopt;
  return nearest->p;
}

}  // namespace zonepack::packer
