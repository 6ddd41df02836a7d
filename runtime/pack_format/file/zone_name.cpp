// SPDX-License-Identifier: Apache-2.0
#include "runtime/pack_format/file/zone_name.hpp"

#include "platform/base/utf8.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack {

bool is_plain_text(std::string_view text) noexcept {
  if (!is_utf8(text)) return false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x20 || c == 0x7F) return false;
    // U+0080 to U+009F, in two bytes.
    if (c == 0xC2 && static_cast<unsigned char>(text[i + 1]) < 0xA0) return false;
  }
  return true;
}

std::optional<NameFault> name_fault(std::string_view name) noexcept {
  if (name.empty()) return NameFault::kEmpty;
  if (name.size() > kMaxNameBytes) return NameFault::kTooLong;
  if (name.front() == '.') return NameFault::kDot;
  if (name.front() == ' ' || name.back() == ' ') return NameFault::kBlank;
  if (name.find_first_of("/\\\"") != name.npos) return NameFault::kSeparator;
  if (!is_plain_text(name)) return NameFault::kNotPlain;
  return std::nullopt;
}

}  // namespace zonepack
