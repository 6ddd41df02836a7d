// SPDX-License-Identifier: Apache-2.0
#include "packer/verify/map_verifier.hpp"

#include <algorithm>
#include <set>

#include "packer/verify/manifest_checks.hpp"
#include "packer/verify/pack_verifier.hpp"
#include "platform/atomic_file.hpp"
#include "platform/base/failure.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

const std::string kManifest(kManifestName);

std::string manifest_problem(const Error& error) {
  switch (error.code) {
    case ErrorCode::kTruncated:
      return "the file has " + std::to_string(error.detail) +
             " bytes, not as many as its header says: it was cut off or joined with another";
    case ErrorCode::kBadMagic:
      return "the file does not begin and end as a manifest does";
    case ErrorCode::kBadVersion:
      return "format version " + std::to_string(error.detail) + ", this program reads " +
             std::to_string(kManifestMajor);
    case ErrorCode::kBadChecksum:
      return "the bytes do not have the BLAKE2b-256 at its end";
    case ErrorCode::kMismatch:
      return "slots of " + std::to_string(error.detail) + " bytes, this format has " +
             std::to_string(kSlotBytes);
    case ErrorCode::kTooLarge:
      return "more portals in all, or more than " + std::to_string(kMaxPortalsPerZone) +
             " of one zone, than the format holds, or a longer file";
    default:
      return "the manifest breaks the rules of the format: " + reason_text(error);
  }
}

class MapVerifier {
 public:
  explicit MapVerifier(const MapFiles& map) : map_(map) {}

  Verdict run() {
    const fb::Manifest* const manifest = read_manifest();
    const std::vector<std::string> names = map_.names();
    std::set<std::string> named;
    if (manifest != nullptr) {
      for (const fb::Zone* zone : *manifest->zones()) named.insert(zone->pack()->str());
      check_zones(*manifest);
    }
    for (const std::string& name : names) {
      const bool is_pack = name.ends_with(".zpk");
      if (manifest == nullptr && is_pack) check_pack(name, "");
      if (manifest != nullptr && !named.contains(name) && (is_pack || is_part_name(name))) {
        verdict_.unnamed.push_back(name);
      }
    }
    return std::move(verdict_);
  }

  // No facts when the header, index or tail of the pack is damaged.
  std::optional<PackFacts> check_pack(const std::string& name, const std::string& zone) {
    ++verdict_.packs;
    Result<std::unique_ptr<MapFile>> file = map_.open(name);
    if (!file) {
      const bool missing = file.error().code == ErrorCode::kNotFound;
      verdict_.problems.push_back(
          {{.file = name, .zone = zone},
           missing ? "the file is not there" : "cannot be opened: " + reason_text(file.error()),
           kCopyAgain});
      return std::nullopt;
    }
    verdict_.bytes += (*file)->size();
    const std::size_t before = verdict_.problems.size();
    std::optional<PackFacts> facts = verify_pack(**file, name, verdict_.problems);
    for (std::size_t i = before; i < verdict_.problems.size(); ++i) {
      Location& place = verdict_.problems[i].place;
      if (place.zone.empty()) place.zone = zone;
    }
    if (facts) verdict_.signatures += facts->nodes.size();
    return facts;
  }

  Verdict& verdict() { return verdict_; }

 private:
  void report(Location place, const std::string& text, const char* remedy) {
    verdict_.problems.push_back({std::move(place), text, remedy});
  }

  const fb::Manifest* read_manifest() {
    const Result<std::unique_ptr<MapFile>> file = map_.open(kManifest);
    if (!file) {
      const bool missing = file.error().code == ErrorCode::kNotFound;
      report({.file = kManifest},
             missing ? "the file is not there: this is no map, or its build never finished"
                     : "cannot be opened: " + reason_text(file.error()),
             kCopyAgain);
      return nullptr;
    }
    if ((*file)->size() > kMaxManifestFileBytes) {
      report({.file = kManifest}, manifest_problem({ErrorCode::kTooLarge, 0}), kCopyAgain);
      return nullptr;
    }
    const auto size = static_cast<std::size_t>((*file)->size());
    words_.resize((size + 7) / 8);
    const auto bytes = std::as_writable_bytes(std::span(words_)).first(size);
    if (const auto read = (*file)->read_at(0, bytes); !read) {
      report({.file = kManifest}, "cannot be read: " + reason_text(read.error()), kCopyAgain);
      return nullptr;
    }
    verdict_.bytes += bytes.size();
    const Result<const fb::Manifest*> checked = check_manifest(bytes);
    if (checked) return *checked;
    const ErrorCode code = checked.error().code;
    const bool whole = code != ErrorCode::kTruncated && code != ErrorCode::kBadMagic &&
                       code != ErrorCode::kBadChecksum && code != ErrorCode::kBadVersion;
    report({.file = kManifest}, manifest_problem(checked.error()),
           whole ? kBuildAgain : kCopyAgain);
    return nullptr;
  }

  void check_zones(const fb::Manifest& manifest) {
    std::vector<std::optional<PackFacts>> packs;
    for (const fb::Zone* zone : *manifest.zones()) {
      const std::string name = zone->name()->str();
      packs.push_back(check_pack(zone->pack()->str(), name));
      if (!packs.back()) continue;
      const bool foreign = packs.back()->zone != name ||
                           !std::ranges::equal(packs.back()->digest, *zone->pack_digest());
      for (const std::string& contradiction : zone_contradictions(manifest, *zone, *packs.back())) {
        report({.file = foreign ? zone->pack()->str() : kManifest, .zone = name},
               "the manifest " + contradiction, foreign ? kWrongFile : kBuildAgain);
      }
      if (foreign) packs.back().reset();
    }
    for (const std::string& contradiction : map_contradictions(manifest, packs)) {
      report({.file = kManifest}, contradiction, kBuildAgain);
    }
  }

  const MapFiles& map_;
  std::vector<std::uint64_t> words_;  // the manifest, aligned
  Verdict verdict_;
};

}  // namespace

Verdict verify_map(const MapFiles& map) { return MapVerifier(map).run(); }

Verdict verify_one_pack(const MapFiles& folder, const std::string& name) {
  MapVerifier verifier(folder);
  verifier.check_pack(name, "");
  return std::move(verifier.verdict());
}

}  // namespace zonepack::packer
