// SPDX-License-Identifier: Apache-2.0
#include "packer/console/words.hpp"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <string_view>

#include "platform/base/file_kind.hpp"
#include "platform/base/natural_order.hpp"

namespace zonepack::packer {

std::string mib_text(ByteCount bytes) {
  constexpr double kLeast = 0.01;
  const double mib = static_cast<double>(bytes) / static_cast<double>(kMiB);
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", bytes == 0 ? 0 : std::max(mib, kLeast));
  return text;
}

std::string size_text(ByteCount bytes) {
  const std::string text = counted(bytes, "byte");
  return bytes < kMiB / 100 ? text : text + " (" + mib_text(bytes) + " MiB)";
}

std::string payload_text(PayloadMask mask) {
  std::string text;
  for (std::uint32_t k = 1; k < kPayloadKinds; ++k) {
    const auto kind = static_cast<fb::PayloadKind>(k);
    if ((mask & mask_of(kind)) == 0) continue;
    if (!text.empty()) text += ',';
    text += zonepack::to_string(kind);
  }
  return text;
}

std::vector<std::size_t> natural_order(const std::vector<std::string>& names) {
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order,
                    [&](std::size_t a, std::size_t b) { return natural_less(names[a], names[b]); });
  return order;
}

}  // namespace zonepack::packer
