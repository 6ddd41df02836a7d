// SPDX-License-Identifier: Apache-2.0
#include "packer/decode/map_reader.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "platform/base/failure.hpp"

namespace zonepack::packer {

void MapReader::fail(const std::string& path, const Error& error) {
  std::string text = path + ": ";
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
              "); 'zonepack verify' reports what is damaged, 'zonepack build' makes the map again";
  }
  throw std::runtime_error(text);
}

MapReader::MapReader(std::filesystem::path folder) : folder_(std::move(folder)) {
  const std::string path = (folder_ / kManifestName).string();
  Result<std::vector<std::byte>> file = read_file(path, kMaxManifestFileBytes);
  if (!file) fail(path, file.error());
  file_ = std::move(*file);
  ManifestFault fault;
  const Result<const fb::Manifest*> checked = check_manifest(file_, &fault);
  if (!checked) {
    throw std::runtime_error(path + ": " + manifest_fault_text(checked.error(), fault) +
                             "; 'zonepack verify' reports what is damaged, 'zonepack build' makes "
                             "the map again");
  }
  manifest_ = *checked;
}

std::vector<ZoneId> MapReader::zones_named(const std::string& name) const {
  const auto& zones = *manifest_->zones();
  std::vector<ZoneId> named;
  std::string known;
  for (ZoneId id = 0; id < zones.size(); ++id) {
    const fb::Zone& zone = *zones.Get(id);
    const bool is_part = zone.parent() != nullptr && zone.parent()->string_view() == name;
    if (is_part || zone.name()->string_view() == name) named.push_back(id);
    known += (known.empty() ? "" : ", ") + zone.name()->str();
  }
  if (!named.empty()) return named;
  throw std::runtime_error(folder_.string() + ": no zone '" + name + "' in this map; it has " +
                           (known.empty() ? "none" : known));
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
