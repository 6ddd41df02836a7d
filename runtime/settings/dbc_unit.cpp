// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_unit.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace zonepack {
namespace {

using Quantity = DbcUnit::Kind;

struct UnitWord {
  std::string_view text;
  Quantity kind;
  double si;
};

constexpr auto kQuantities = std::to_array<UnitWord>({
    {"m", Quantity::kLength, 1},
    {"metre", Quantity::kLength, 1},
    {"meter", Quantity::kLength, 1},
    {"mm", Quantity::kLength, 0.001},
    {"millimetre", Quantity::kLength, 0.001},
    {"millimeter", Quantity::kLength, 0.001},
    {"cm", Quantity::kLength, 0.01},
    {"dm", Quantity::kLength, 0.1},
    {"km", Quantity::kLength, 1000},
    {"um", Quantity::kLength, 1e-6},
    {"in", Quantity::kLength, 0.0254},
    {"inch", Quantity::kLength, 0.0254},
    {"ft", Quantity::kLength, 0.3048},
    {"feet", Quantity::kLength, 0.3048},
    {"foot", Quantity::kLength, 0.3048},
    {"mi", Quantity::kLength, 1609.344},
    {"mile", Quantity::kLength, 1609.344},
    {"nmi", Quantity::kLength, 1852},
    {"rad", Quantity::kAngle, 1},
    {"radian", Quantity::kAngle, 1},
    {"mrad", Quantity::kAngle, 0.001},
    {"urad", Quantity::kAngle, 1e-6},
    {"deg", Quantity::kAngle, kDegree_rad},
    {"degree", Quantity::kAngle, kDegree_rad},
    {"mdeg", Quantity::kAngle, kDegree_rad / 1000},
    {"turn", Quantity::kAngle, kTurn_rad},
    {"rev", Quantity::kAngle, kTurn_rad},
    {"revolution", Quantity::kAngle, kTurn_rad},
    {"rotation", Quantity::kAngle, kTurn_rad},
    {"rot", Quantity::kAngle, kTurn_rad},
    {"r", Quantity::kAngle, kTurn_rad},
    {"u", Quantity::kAngle, kTurn_rad},   // German: Umdrehung
    {"tr", Quantity::kAngle, kTurn_rad},  // French: tour
    {"1", Quantity::kAngle, kTurn_rad},   // 1/min; alone it is no unit
    {"tick", Quantity::kTicks, 1},
    {"count", Quantity::kTicks, 1},
    {"cnt", Quantity::kTicks, 1},
    {"pulse", Quantity::kTicks, 1},
    {"inc", Quantity::kTicks, 1},
    {"increment", Quantity::kTicks, 1},
    {"step", Quantity::kTicks, 1},
    {"%", Quantity::kPercent, 0.01},
    {"pct", Quantity::kPercent, 0.01},
});

struct UnitTime {
  std::string_view text;
  double seconds;
};
constexpr auto kTimes = std::to_array<UnitTime>({{"s", 1},
                                                 {"sec", 1},
                                                 {"second", 1},
                                                 {"ms", 0.001},
                                                 {"min", 60},
                                                 {"minute", 60},
                                                 {"h", 3600},
                                                 {"hr", 3600},
                                                 {"hour", 3600}});

struct UnitAlias {
  std::string_view text, means;
};
constexpr auto kAliases = std::to_array<UnitAlias>({{"kph", "km/h"},
                                                    {"kmh", "km/h"},
                                                    {"kmph", "km/h"},
                                                    {"mph", "mi/h"},
                                                    {"mps", "m/s"},
                                                    {"ms-1", "m/s"},
                                                    {"fps", "ft/s"},
                                                    {"kn", "nmi/h"},
                                                    {"kt", "nmi/h"},
                                                    {"knot", "nmi/h"},
                                                    {"rpm", "1/min"},
                                                    {"min-1", "1/min"},
                                                    {"rps", "1/s"},
                                                    {"dps", "deg/s"},
                                                    {"rads-1", "rad/s"},
                                                    {"/cent", "%"}});  // "percent"

constexpr auto kNoUnits =
    std::to_array<std::string_view>({"", "-", "--", "1", "none", "raw", "bit", "bits", "n/a", "na",
                                     "nounit", "unitless", "dimensionless", "value"});

void replace_each(std::string& text, std::string_view what, std::string_view with) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += with.size()) {
    text.replace(at, what.size(), with);
  }
}

// Small letters without blanks and other decoration: "Deg / Sec" becomes "deg/sec".
std::string plain_unit(std::string_view given) {
  std::string text;
  for (const char c : given) {
    if (c >= 'A' && c <= 'Z') {
      text += static_cast<char>(c - 'A' + 'a');
    } else if (std::string_view(" \t\r\n[]()^*.").find(c) == std::string_view::npos) {
      text += c;
    }
  }
  replace_each(text, "\xC2\xB0", "deg");
  replace_each(text, "\xB0", "deg");
  replace_each(text, "per", "/");
  return text;
}

// `text` may be a plural.
template <typename Words>
const auto* find_unit_word(const Words& words, std::string_view text) {
  auto at = std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.text == text; });
  if (at == words.end() && text.size() > 2 && text.ends_with('s')) {
    text.remove_suffix(1);
    at = std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.text == text; });
  }
  return at == words.end() ? nullptr : &*at;
}

}  // namespace

DbcUnit parse_dbc_unit(std::string_view given) {
  std::string text = plain_unit(given);
  if (std::find(kNoUnits.begin(), kNoUnits.end(), text) != kNoUnits.end()) return {Quantity::kNone};
  if (const UnitAlias* const alias = find_unit_word(kAliases, text)) text = alias->means;
  const std::size_t slash = text.find('/');
  const UnitWord* const word = find_unit_word(kQuantities, std::string_view(text).substr(0, slash));
  if (word == nullptr) return {};
  DbcUnit unit{word->kind, word->si, false};
  if (slash == text.npos) return unit;
  const UnitTime* const time = find_unit_word(kTimes, std::string_view(text).substr(slash + 1));
  if (time == nullptr) return {};
  unit.si /= time->seconds;
  unit.per_time = true;
  return unit;
}

}  // namespace zonepack
