// SPDX-License-Identifier: Apache-2.0
#include "packer/console/text_table.hpp"

#include <algorithm>
#include <cstdio>

#include "platform/base/require.hpp"
#include "platform/base/utf8.hpp"

namespace zonepack::packer {
namespace {

bool is_number(const std::string& text) {
  return text.find_first_not_of("0123456789.-") == text.npos;
}

}  // namespace

void TextTable::add(std::vector<std::string> cells) {
  ZP_REQUIRE(cells.size() == rows_.front().size());
  rows_.push_back(std::move(cells));
}

void TextTable::print(std::ostream& out) const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> widths(columns);
  std::vector<bool> numbers(columns, rows_.size() > 1);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      widths[c] = std::max(widths[c], utf8_width(rows_[r][c]));
      if (r > 0 && !is_number(rows_[r][c])) numbers[c] = false;
    }
  }
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::string pad(widths[c] - utf8_width(row[c]), ' ');
      line += (c == 0 ? "" : "  ") + (numbers[c] ? pad + row[c] : row[c] + pad);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << "\n";
  }
}

std::string ratio_text(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", static_cast<double>(part) / static_cast<double>(whole));
  return text;
}

}  // namespace zonepack::packer
