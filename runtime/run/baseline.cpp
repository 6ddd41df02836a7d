// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/baseline.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

namespace zonepack {
namespace {

enum Column : std::size_t { kTime, kWorkingMemory, kRemoved, kRetrieved, kColumns };
constexpr std::array<std::string_view, kColumns> kNames = {"t", "wm", "cum_removed",
                                                           "cum_retrieved"};

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> cell_value(std::string_view text) noexcept {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  Outcome<std::vector<BaselineRow>> read() {
    std::ifstream in(path_);
    if (!in) {
      return failure(path_ + ": cannot read the baseline: " + std::strerror(errno),
                     ErrorCode::kNotFound);
    }
    for (std::string line; std::getline(in, line);) {
      ++line_;
      if (line.ends_with('\r')) line.pop_back();
      if (line.empty() || line.starts_with('#')) continue;
      const std::vector<std::string_view> cells = split_cells(line);
      if (const auto taken = width_ == 0 ? header(cells) : row(cells); !taken) return taken.error();
    }
    if (in.bad()) return failure(path_ + ": cannot read the baseline to its end", ErrorCode::kIo);
    if (rows_.empty()) {
      return failure(path_ + ": the baseline has no rows; expected a CSV file with columns " +
                     wanted());
    }
    return std::move(rows_);
  }

 private:
  static std::string wanted() {
    std::string text;
    for (const std::string_view name : kNames) text.append(text.empty() ? "" : ", ").append(name);
    return text;
  }

  Failure at(const std::string& what) const {
    return failure(path_ + ":" + std::to_string(line_) + ": " + what);
  }

  Outcome<void> header(const std::vector<std::string_view>& cells) {
    for (std::size_t i = 0; i < kColumns; ++i) {
      const auto found = std::ranges::find(cells, kNames[i]);
      if (found == cells.end()) {
        return at("no column '" + std::string(kNames[i]) + "'; a baseline needs the columns " +
                  wanted());
      }
      columns_[i] = static_cast<std::size_t>(found - cells.begin());
    }
    width_ = cells.size();
    return {};
  }

  Outcome<void> row(const std::vector<std::string_view>& cells) {
    if (cells.size() != width_) {
      return at(std::to_string(cells.size()) + " cells where the column names have " +
                std::to_string(width_));
    }
    std::array<double, kColumns> values{};
    for (std::size_t i = 0; i < kColumns; ++i) {
      const std::optional<double> value = cell_value(cells[columns_[i]]);
      if (!value) {
        return at("column " + std::string(kNames[i]) + ": '" + std::string(cells[columns_[i]]) +
                  "' is not a number");
      }
      values[i] = *value;
    }
    if (rows_.empty()) first_t_s_ = values[kTime];
    const double t_s = values[kTime] - first_t_s_;
    if (!rows_.empty() && t_s < rows_.back().t_s) return at("time goes back");
    const auto count = static_cast<double>(rows_.size() + 1);
    rows_.push_back({.t_s = t_s,
                     .in_memory = values[kWorkingMemory],
                     .loaded = values[kRetrieved],
                     .unloaded = std::max(0.0, values[kRemoved] - count)});
    return {};
  }

  const std::string& path_;
  std::vector<BaselineRow> rows_;
  std::array<std::size_t, kColumns> columns_{};
  std::size_t width_ = 0;
  std::size_t line_ = 0;
  double first_t_s_ = 0;
};

}  // namespace

Outcome<std::vector<BaselineRow>> read_baseline(const std::string& path) {
  return Reader(path).read();
}

}  // namespace zonepack
