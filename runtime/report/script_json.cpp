// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/script_json.hpp"

#include <algorithm>
#include <cmath>

#include "platform/base/json_text.hpp"
#include "platform/base/utf8.hpp"

namespace zonepack::report {
namespace {

constexpr double kMost = 9e15;  // whole numbers that a script's doubles hold exactly

template <typename Range, typename Text>
std::string list_of(const Range& items, Text&& text) {
  std::string list = "[";
  for (const auto& item : items) {
    if (list.size() > 1) list += ',';
    list += text(item);
  }
  return list + "]";
}

}  // namespace

std::string script_string(std::string_view text) {
  std::string valid;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      valid += "\xEF\xBF\xBD";
      text.remove_prefix(1);
    } else {
      valid.append(text.substr(0, length));
      text.remove_prefix(length);
    }
  }
  std::string json;
  for (const char c : json_quoted(valid)) {
    if (c == '<') {
      json += "\\u003c";
    } else if (c == '>') {
      json += "\\u003e";
    } else if (c == '&') {
      json += "\\u0026";
    } else {
      json += c;
    }
  }
  return json;
}

std::string script_strings(std::span<const std::string> texts) {
  return list_of(texts, [](const std::string& text) { return script_string(text); });
}

std::string script_differences(std::span<const double> values, double per_unit) {
  std::int64_t last = 0;
  return list_of(values, [&](double value) -> std::string {
    if (!std::isfinite(value)) return "null";
    const std::int64_t whole = std::llround(std::clamp(value * per_unit, -kMost, kMost));
    const std::int64_t difference = whole - last;
    last = whole;
    return std::to_string(difference);
  });
}

std::string script_numbers(std::span<const std::int64_t> values) {
  return list_of(values, [](std::int64_t value) { return std::to_string(value); });
}

}  // namespace zonepack::report
