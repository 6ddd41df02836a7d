// SPDX-License-Identifier: Apache-2.0
#include "packer/build/leftovers.hpp"

#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <set>
#include <stdexcept>
#include <string_view>

#include "platform/base/failure.hpp"
#include "platform/base/file_kind.hpp"
#include "platform/files/atomic_file.hpp"
#include "platform/files/storage.hpp"
#include "runtime/pack_format/file/manifest_file.hpp"

namespace zonepack::packer {
namespace {

std::set<std::string> named_packs(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(folder, ignored)) {
    throw std::runtime_error(
        folder.string() + ": is a file; expected the folder of a map that 'zonepack build' wrote");
  }
  const std::string path = (folder / kManifestName).string();
  const Result<std::vector<std::byte>> file = read_file(path, kMaxManifestFileBytes);
  const Result<const fb::Manifest*> manifest =
      file ? check_manifest(*file) : Result<const fb::Manifest*>(file.error());
  if (!manifest) {
    const std::string_view magic(reinterpret_cast<const char*>(kManifestMagic.data()),
                                 kManifestMagic.size());
    const std::string kind = misplaced_at(path, magic);
    throw std::runtime_error(path + ": " + (kind.empty() ? reason_text(manifest.error()) : kind) +
                             "; without a whole manifest every pack would be removed, so none is: "
                             "build the map again or copy its manifest here");
  }
  std::set<std::string> names;
  for (const fb::Zone* zone : *(*manifest)->zones()) names.insert(zone->pack()->str());
  return names;
}

bool is_pack_name(std::string_view name) {
  constexpr std::string_view kEnd = ".zpk";
  constexpr std::size_t kDigits = 16;
  if (!name.ends_with(kEnd)) return false;
  name.remove_suffix(kEnd.size());
  if (name.size() < kDigits + 2 || name[name.size() - kDigits - 1] != '-') return false;
  return std::ranges::all_of(name.substr(name.size() - kDigits), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
  });
}

constexpr std::string_view kPartMark = ".part-";

bool is_part_of_map(std::string_view name) {
  if (!is_part_name(name)) return false;
  const std::string_view whole = name.substr(0, name.rfind(kPartMark));
  return whole == kManifestName || whole.ends_with(".zpk");
}

// The process that writes a part, or wrote it; 0 when the name does not say.
int writer_of(std::string_view part) {
  const std::string_view digits = part.substr(part.rfind(kPartMark) + kPartMark.size());
  int process = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), process);
  return std::max(process, 0);
}

bool runs(int process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

void refuse_while_written(const std::filesystem::path& folder, std::string_view name) {
  const int process = writer_of(name);
  if (process == 0 || !runs(process)) return;
  throw std::runtime_error((folder / name).string() + " is being written by process " +
                           std::to_string(process) +
                           ", which still runs; wait for the build to end, or stop it");
}

}  // namespace

std::vector<Leftover> find_leftovers(const std::filesystem::path& folder) {
  const std::set<std::string> named = named_packs(folder);
  std::vector<Leftover> leftovers;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_symlink() || !entry.is_regular_file() || named.contains(name)) continue;
    const bool part = is_part_of_map(name);
    if (!part && !is_pack_name(name)) continue;
    if (part) refuse_while_written(folder, name);
    leftovers.push_back({name, entry.file_size()});
  }
  std::ranges::sort(leftovers, {}, &Leftover::name);
  return leftovers;
}

void remove_parts_of_killed(const std::filesystem::path& folder) noexcept {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_symlink(ignored) || !entry.is_regular_file(ignored) || !is_part_of_map(name)) {
      continue;
    }
    if (const int process = writer_of(name); process != 0 && !runs(process)) {
      std::filesystem::remove(entry.path(), ignored);
    }
  }
}

void remove_leftover(const std::filesystem::path& folder, const Leftover& leftover) {
  const std::filesystem::path path = folder / leftover.name;
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw std::runtime_error(path.string() + ": cannot be removed: " + error.message());
}

}  // namespace zonepack::packer
