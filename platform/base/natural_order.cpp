// SPDX-License-Identifier: Apache-2.0
#include "platform/base/natural_order.hpp"

#include <cstddef>

namespace zonepack {
namespace {

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

// The digits from `at` on, without leading zeros; moves `at` behind them.
std::string_view take_number(std::string_view text, std::size_t& at) noexcept {
  while (at < text.size() && text[at] == '0') ++at;
  const std::size_t begin = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  return text.substr(begin, at - begin);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) noexcept {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = take_number(a, i), y = take_number(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      continue;
    }
    if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    ++i;
    ++j;
  }
  const bool ends_first = i == a.size() && j < b.size();
  const bool both_end = i == a.size() && j == b.size();
  return ends_first || (both_end && a < b);
}

}  // namespace zonepack
