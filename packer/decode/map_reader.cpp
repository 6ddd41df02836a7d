// SPDX-License-Identifier: Apache-2.0
#include "packer/decode/map_reader.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "platform/base/failure.hpp"
#include "platform/base/file_kind.hpp"
#include "platform/base/natural_order.hpp"
#include "platform/base/nearest_word.hpp"
#include "platform/base/shell_word.hpp"

namespace zonepack::packer {

namespace {

// A folder is expected; a file of the map is no folder, but often what the user meant.
void refuse_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  const std::string kind = misplaced_at(path.string(), "");
  throw std::runtime_error(path.string() + ": " + (kind.empty() ? "is a file" : kind) +
                           "; expected the folder of a map that 'zonepack build' wrote");
}

}  // namespace

std::string misplaced_map_file(const std::string& path) {
  const bool is_manifest = std::filesystem::path(path).filename() == kManifestName;
  const Magic& magic = is_manifest ? kManifestMagic : kPackMagic;
  const std::string kind =
      misplaced_at(path, {reinterpret_cast<const char*>(magic.data()), magic.size()});
  if (kind.empty()) return {};
  return kind + "; expected " + (is_manifest ? "the manifest of a map" : "a pack of a map") +
         " as 'zonepack build' writes it: copy it again, or build the map again";
}

void MapReader::fail(const std::string& path, const Error& error) {
  std::string text = path + ": ";
  if (const std::string kind = misplaced_map_file(path); !kind.empty()) {
    throw std::runtime_error(text + kind);
  }
  switch (error.code) {
    case ErrorCode::kNotFound:
      text += "not found; is this a map that 'zonepack build' wrote?";
      break;
    case ErrorCode::kIo:
      text += "cannot be read: " + reason_text(error);
      break;
    case ErrorCode::kBadVersion:
      text += "format version " + std::to_string(error.detail) +
              " is unknown to this program; use the zonepack that wrote it, or build the map again";
      break;
    default:
      text += std::string(to_string(error.code)) + " (" + std::to_string(error.detail) +
              "); to see what is damaged: zonepack verify " + shell_quoted(path) +
              "; 'zonepack build' makes the map again";
  }
  throw std::runtime_error(text);
}

MapReader::MapReader(std::filesystem::path folder) : folder_(std::move(folder)) {
  refuse_file(folder_);
  const std::string path = (folder_ / kManifestName).string();
  Result<std::vector<std::byte>> file = read_file(path, kMaxManifestFileBytes);
  if (!file) fail(path, file.error());
  file_ = std::move(*file);
  ManifestFault fault;
  const Result<const fb::Manifest*> checked = check_manifest(file_, &fault);
  if (!checked) {
    throw std::runtime_error(path + ": " + manifest_fault_text(checked.error(), fault) +
                             "; to see what is damaged: zonepack verify " +
                             shell_quoted(folder_.string()) +
                             "; 'zonepack build' makes the map again");
  }
  manifest_ = *checked;
}

std::vector<ZoneId> MapReader::zones_named(const std::string& name) const {
  const auto& zones = *manifest_->zones();
  std::vector<ZoneId> named;
  std::vector<std::string> known;
  std::set<std::string> parents;
  for (ZoneId id = 0; id < zones.size(); ++id) {
    const fb::Zone& zone = *zones.Get(id);
    const std::string parent = flatbuffers::GetString(zone.parent());
    if (parent == name || zone.name()->string_view() == name) named.push_back(id);
    known.push_back(zone.name()->str());
    if (!parent.empty()) parents.insert(parent);
  }
  if (!named.empty()) return named;
  known.insert(known.end(), parents.begin(), parents.end());
  std::ranges::sort(known, natural_less);
  const std::string* const nearest = nearest_word(name, known);
  throw std::runtime_error(folder_.string() + ": no zone '" + name + "' in this map; it has " +
                           listed(known) +
                           (nearest != nullptr ? "; did you mean '" + *nearest + "'?" : ""));
}

std::string MapReader::pack_path(const fb::Zone& zone) const {
  return (folder_ / zone.pack()->str()).string();
}

PackReader MapReader::open_pack(const fb::Zone& zone) const {
  Digest32 digest;
  std::copy(zone.pack_digest()->begin(), zone.pack_digest()->end(), digest.begin());
  Result<PackReader> pack = PackReader::open(pack_path(zone), &digest);
  if (!pack) fail(pack_path(zone), pack.error());
  if (pack->index().signatures() != zone.signatures()) {
    fail(pack_path(zone), {ErrorCode::kMismatch, pack->index().signatures()});
  }
  return std::move(*pack);
}

}  // namespace zonepack::packer
