// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace zonepack::packer {

// Rows of text in columns; the first row is the head. Columns of numbers are aligned to the right,
// and widths are counted in code points, as most terminals show them.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> head) { rows_.push_back(std::move(head)); }
  // `cells`: as many as in the head.
  void add(std::vector<std::string> cells);
  void print(std::ostream& out) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

// 0.437 as "0.44".
std::string ratio_text(std::uint64_t part, std::uint64_t whole);

}  // namespace zonepack::packer
