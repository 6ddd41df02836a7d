// SPDX-License-Identifier: Apache-2.0
#include "platform/base/file_kind.hpp"

#include <array>
#include <cstdio>
#include <memory>

namespace zonepack {

std::string stand_in(std::string_view bytes) {
  struct Kind {
    std::string_view magic;
    const char* text;
  };
  using std::string_view_literals::operator""sv;
  static constexpr std::array<Kind, 7> kKinds = {{
      {"version https://git-lfs"sv, "a Git LFS pointer, not the file itself; run: git lfs pull"},
      {"\x1F\x8B"sv, "compressed by gzip; run gunzip on it first"},
      {"PK\x03\x04"sv, "a ZIP archive; run unzip on it first"},
      {"\xFD"
       "7zXZ\0"sv,
       "compressed by xz; run unxz on it first"},
      {"(\xB5/\xFD"sv, "compressed by zstd; run unzstd on it first"},
      {"BZh"sv, "compressed by bzip2; run bunzip2 on it first"},
      {"7z\xBC\xAF"sv, "a 7-Zip archive; unpack it first"},
  }};
  for (const Kind& kind : kKinds) {
    if (bytes.starts_with(kind.magic)) return kind.text;
  }
  return {};
}

std::string stand_in_at(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  std::array<char, kFileKindBytes> bytes{};
  const std::size_t size = file ? std::fread(bytes.data(), 1, bytes.size(), file.get()) : 0;
  return stand_in({bytes.data(), size});
}

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

}  // namespace zonepack
