// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/bus/can_source.hpp"

#include <charconv>
#include <string_view>
#include <utility>

namespace zonepack {
namespace {

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<CanSourceChoice> parse_can_source(const std::string& text) {
  using Kind = CanSourceChoice::Kind;
  constexpr std::pair<std::string_view, Kind> kSources[] = {
      {"socketcan:", Kind::kSocketCan}, {"log:", Kind::kLog}, {"sim:", Kind::kScript}};
  for (const auto& [prefix, kind] : kSources) {
    if (!text.starts_with(prefix)) continue;
    CanSourceChoice choice{kind, text.substr(prefix.size())};
    const std::size_t at = choice.name.rfind('@');
    if (kind != Kind::kSocketCan && at != std::string::npos) {
      if (const auto speed = number_in(std::string_view(choice.name).substr(at + 1))) {
        if (!(*speed >= 0.001 && *speed <= 1e6)) return std::nullopt;
        choice.speed = *speed;
        choice.name.resize(at);
      }
    }
    if (choice.name.empty()) return std::nullopt;
    return choice;
  }
  return std::nullopt;
}

}  // namespace zonepack
