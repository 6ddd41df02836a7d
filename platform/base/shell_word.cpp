// SPDX-License-Identifier: Apache-2.0
#include "platform/base/shell_word.hpp"

namespace zonepack {

std::string shell_quoted(std::string_view path) {
  std::string text = "'";
  for (const char c : path) {
    if (c == '\'') {
      text += "'\\''";
    } else {
      text += c;
    }
  }
  return text + "'";
}

std::string shell_word(std::string_view path) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-+=:,@%";
  const bool plain = !path.empty() && path.find_first_not_of(kPlain) == path.npos;
  return plain ? std::string(path) : shell_quoted(path);
}

}  // namespace zonepack
