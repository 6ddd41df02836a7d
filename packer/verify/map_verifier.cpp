// SPDX-License-Identifier: Apache-2.0
#include "packer/verify/map_verifier.hpp"

#include <algorithm>
#include <set>

#include "packer/verify/manifest_checks.hpp"
#include "packer/verify/pack_verifier.hpp"
#include "platform/base/failure.hpp"
#include "platform/files/atomic_file.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

const std::string kManifest(kManifestName);

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

  void report_all(const Contradictions& contradictions, const char* who, const Location& place,
                  const char* remedy) {
    const std::size_t listed = std::min(contradictions.size(), kMostListed);
    for (std::size_t i = 0; i < listed; ++i) report(place, who + contradictions[i], remedy);
    if (contradictions.size() > listed) {
      verdict_.problems.push_back(unlisted(place, contradictions.size() - listed));
    }
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
      report({.file = kManifest},
             to_string(Excess{LimitId::kManifestBytes, (*file)->size() - kManifestFrameBytes}),
             kCopyAgain);
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
    ManifestFault fault;
    const Result<const fb::Manifest*> checked = check_manifest(bytes, &fault);
    if (checked) return *checked;
    const ErrorCode code = checked.error().code;
    const bool whole = code != ErrorCode::kTruncated && code != ErrorCode::kBadMagic &&
                       code != ErrorCode::kBadChecksum && code != ErrorCode::kBadVersion;
    Location place{.file = kManifest};
    if (fault.part == ManifestFault::Part::kZone && !fault.name.empty()) {
      place.zone = fault.name;
      fault.part = ManifestFault::Part::kWhole;  // named by its place
    }
    report(std::move(place), manifest_fault_text(checked.error(), fault),
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
      report_all(zone_contradictions(manifest, *zone, *packs.back()), "the manifest ",
                 {.file = foreign ? zone->pack()->str() : kManifest, .zone = name},
                 foreign ? kWrongFile : kBuildAgain);
      if (foreign) packs.back().reset();
    }
    report_all(map_contradictions(manifest, packs), "", {.file = kManifest}, kBuildAgain);
  }

  const MapFiles& map_;
  std::vector<std::uint64_t> words_;  // the manifest, aligned
  Verdict verdict_;
};

}  // namespace

std::uint64_t Verdict::problem_count() const {
  std::uint64_t count = 0;
  for (const Problem& problem : problems) count += problem.count;
  return count;
}

Verdict verify_map(const MapFiles& map) { return MapVerifier(map).run(); }

Verdict verify_one_pack(const MapFiles& folder, const std::string& name) {
  MapVerifier verifier(folder);
  verifier.check_pack(name, "");
  return std::move(verifier.verdict());
}

}  // namespace zonepack::packer
