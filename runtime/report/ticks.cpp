// SPDX-License-Identifier: Apache-2.0
#include "runtime/report/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "runtime/report/format.hpp"

namespace zonepack::report {
namespace {

struct Unit {
  double size = 1;
  const char* name = "";
};

Unit unit_of(double largest, Quantity quantity) {
  if (quantity == Quantity::kNumber) return {};
  constexpr std::array kNames = {" B", " KiB", " MiB", " GiB", " TiB", " PiB", " EiB"};
  std::size_t power = 0;
  double size = 1;
  while (largest >= 2 * 1024 * size && power + 1 < kNames.size()) {
    size *= 1024;
    ++power;
  }
  return {size, kNames[power]};
}

struct Step {
  double size = 1;
  int decimals = 0;  // digits after the point that a multiple needs
};

double power_of_ten(int exponent) noexcept {
  double power = 1;
  for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
  return exponent < 0 ? 1 / power : power;
}

// The smallest of 1, 2, 5 times a power of ten that is at least `least`.
Step round_step(double least) noexcept {
  int exponent = 0;
  while (exponent > -300 && power_of_ten(exponent) >= least) --exponent;
  while (exponent < 300 && 10 * power_of_ten(exponent) < least) ++exponent;
  double factor = 10;
  for (const double candidate : {5.0, 2.0, 1.0}) {
    if (candidate * power_of_ten(exponent) >= least) factor = candidate;
  }
  if (factor == 10) return {power_of_ten(exponent + 1), std::max(0, -exponent - 1)};
  const double size =
      exponent < 0 ? factor / power_of_ten(-exponent) : factor * power_of_ten(exponent);
  return {size, std::max(0, -exponent)};
}

bool is_range(double low, double high) noexcept {
  return std::isfinite(low) && std::isfinite(high) && low < high && std::isfinite(high - low);
}

}  // namespace

Ticks make_ticks(double low, double high, int wanted, Quantity quantity) {
  Ticks ticks;
  if (!is_range(low, high) || wanted < 1) {
    ticks.values = {0};
    ticks.labels = {"0"};
    return ticks;
  }
  const Unit unit = unit_of(std::max(std::abs(low), std::abs(high)), quantity);
  const Step step = round_step((high - low) / unit.size / wanted);
  ticks.step = step.size * unit.size;
  const double first = std::ceil(low / ticks.step - 1e-9);
  for (int i = 0; i <= 2 * wanted + 2; ++i) {
    const double value = (first + i) * ticks.step;
    if (value > high + ticks.step * 1e-9) break;
    ticks.values.push_back(value);
    ticks.labels.push_back(
        value == 0 ? "0" : format_number(value / unit.size, step.decimals) + unit.name);
  }
  return ticks;
}

double round_up_to_tick(double high, int wanted, Quantity quantity) {
  if (!is_range(0, high)) return 1;
  const Ticks ticks = make_ticks(0, high, wanted, quantity);
  return std::ceil(high / ticks.step - 1e-9) * ticks.step;
}

}  // namespace zonepack::report
