// SPDX-License-Identifier: Apache-2.0
#include "runtime/run/figures/csv_columns.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <vector>

namespace zonepack {
namespace {

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
  Reader(const std::string& path, const std::string& what, std::span<const std::string_view> names)
      : path_(path), what_(what), names_(names) {}

  Outcome<void> read(const std::function<Outcome<void>(std::span<const double>)>& take) {
    std::ifstream in(path_);
    if (!in) {
      return failure(path_ + ": cannot read " + what_ + ": " + std::strerror(errno),
                     ErrorCode::kNotFound);
    }
    bool empty = true;
    for (std::string line; std::getline(in, line);) {
      ++line_;
      if (line.ends_with('\r')) line.pop_back();
      if (line.empty() || line.starts_with('#')) continue;
      const std::vector<std::string_view> cells = split_cells(line);
      if (width_ == 0) {
        if (auto known = header(cells); !known) return known;
        continue;
      }
      if (auto read = row(cells); !read) return read;
      if (const auto taken = take(values_); !taken) return at(taken.error().message);
      empty = false;
    }
    if (in.bad()) return failure(path_ + ": cannot read " + what_ + " to its end", ErrorCode::kIo);
    if (empty) {
      return failure(path_ + ": " + what_ + " has no rows; expected a CSV file with columns " +
                     wanted());
    }
    return {};
  }

 private:
  std::string wanted() const {
    std::string text;
    for (const std::string_view name : names_) text.append(text.empty() ? "" : ", ").append(name);
    return text;
  }

  Failure at(const std::string& text) const {
    return failure(path_ + ":" + std::to_string(line_) + ": " + text);
  }

  Outcome<void> header(const std::vector<std::string_view>& cells) {
    for (const std::string_view name : names_) {
      const auto found = std::ranges::find(cells, name);
      if (found == cells.end()) {
        return at("no column '" + std::string(name) + "'; expected the columns " + wanted());
      }
      columns_.push_back(static_cast<std::size_t>(found - cells.begin()));
    }
    width_ = cells.size();
    return {};
  }

  Outcome<void> row(const std::vector<std::string_view>& cells) {
    if (cells.size() != width_) {
      return at(std::to_string(cells.size()) + " cells where the column names have " +
                std::to_string(width_));
    }
    values_.clear();
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::optional<double> value = cell_value(cells[columns_[i]]);
      if (!value) {
        return at("column " + std::string(names_[i]) + ": '" + std::string(cells[columns_[i]]) +
                  "' is not a number");
      }
      values_.push_back(*value);
    }
    return {};
  }

  const std::string& path_;
  const std::string& what_;
  std::span<const std::string_view> names_;
  std::vector<std::size_t> columns_;
  std::vector<double> values_;
  std::size_t width_ = 0;
  std::size_t line_ = 0;
};

}  // namespace

Outcome<void> read_csv_columns(const std::string& path, const std::string& what,
                               std::span<const std::string_view> names,
                               const std::function<Outcome<void>(std::span<const double>)>& row) {
  return Reader(path, what, names).read(row);
}

}  // namespace zonepack
