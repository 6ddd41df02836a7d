// SPDX-License-Identifier: Apache-2.0
#include "platform/base/base64.hpp"

#include <cstddef>

namespace zonepack {

void append_base64(ByteSpan bytes, std::string& text) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t begin = text.size();
  text.resize(begin + (bytes.size() + 2) / 3 * 4, '=');
  char* out = text.data() + begin;
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? std::to_integer<unsigned>(bytes[i]) : 0u;
  };
  for (std::size_t i = 0; i < bytes.size(); i += 3, out += 4) {
    const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    out[0] = kDigits[group >> 18];
    out[1] = kDigits[group >> 12 & 63];
    if (i + 1 < bytes.size()) out[2] = kDigits[group >> 6 & 63];
    if (i + 2 < bytes.size()) out[3] = kDigits[group & 63];
  }
}

}  // namespace zonepack
