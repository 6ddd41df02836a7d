// SPDX-License-Identifier: Apache-2.0
#include "platform/base/file_kind.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <system_error>

#include "platform/base/shell_word.hpp"

namespace zonepack {

namespace {

using std::string_view_literals::operator""sv;

struct StandIn {
  std::string_view magic;
  const char* text;
};

// The text of the kind, with the path as a word of a shell in the place of @.
std::string kind_in(std::span<const StandIn> kinds, std::string_view bytes, std::string_view path) {
  for (const StandIn& kind : kinds) {
    if (!bytes.starts_with(kind.magic)) continue;
    std::string text = kind.text;
    const std::size_t at = text.find('@');
    if (at != text.npos) text.replace(at, 1, path.empty() ? "FILE" : shell_quoted(path));
    return text;
  }
  return {};
}

// Nothing when the file cannot be read; a folder can be opened but not read.
std::optional<std::string> first_bytes_of(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return std::nullopt;
  std::string bytes(kFileKindBytes, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (std::ferror(file.get()) != 0) return std::nullopt;
  return bytes;
}

}  // namespace

std::string stand_in(std::string_view bytes, std::string_view path) {
  static constexpr std::array<StandIn, 7> kKinds = {{
      {"version https://git-lfs"sv,
       "a Git LFS pointer, not the file itself; run: git lfs pull (package git-lfs)"},
      {"\x1F\x8B"sv, "compressed by gzip; run gunzip first: gunzip < @ > NEW"},
      {"PK\x03\x04"sv, "a ZIP archive; run unzip first: unzip @"},
      {"\xFD"
       "7zXZ\0"sv,
       "compressed by xz; run unxz first: unxz < @ > NEW"},
      {"(\xB5/\xFD"sv, "compressed by zstd; run unzstd first: unzstd < @ > NEW"},
      {"BZh"sv, "compressed by bzip2; run bunzip2 first: bunzip2 < @ > NEW"},
      {"7z\xBC\xAF"sv, "a 7-Zip archive; unpack it first: 7z x @ (package p7zip-full)"},
  }};
  return kind_in(kKinds, bytes, path);
}

std::string known_kind(std::string_view bytes, std::string_view path) {
  static constexpr std::array<StandIn, 9> kKinds = {{
      {"SQLite format 3\0"sv, "a SQLite database"},
      {"\x89ZPK\r\n\x1A\n"sv, "a pack of a map (*.zpk)"},
      {"\x89ZPM\r\n\x1A\n"sv, "a map's manifest (manifest.zpm)"},
      {"\x89ZPR\r\n\x1A\n"sv, "a recording of zoned"},
      {"\x89PNG\r\n\x1A\n"sv, "a PNG picture"},
      {"\xFF\xD8\xFF"sv, "a JPEG picture"},
      {"P5"sv, "a PGM picture"},
      {"%PDF"sv, "a PDF document"},
      {"\x7F"
       "ELF"sv,
       "a program"},
  }};
  const std::string kind = stand_in(bytes, path);
  return kind.empty() ? kind_in(kKinds, bytes, path) : kind;
}

std::string misplaced_at(const std::string& path, std::string_view magic) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return "is a folder";
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  const std::optional<std::string> bytes = first_bytes_of(path);
  if (!bytes) return {};
  if (bytes->empty()) return "is empty (0 bytes)";
  if (!magic.empty() && bytes->starts_with(magic)) return {};
  const std::string kind = known_kind(*bytes, path);
  return kind.empty() ? kind : "is " + kind;
}

std::string stand_in_at(const std::string& path) {
  return stand_in(first_bytes_of(path).value_or(""), path);
}

}  // namespace zonepack
