// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "platform/base/result.hpp"
#include "runtime/client/signature_view.hpp"
#include "runtime/client/zone_grant.hpp"

namespace zonepack {

enum class ReadStatus : std::uint8_t {
  kOk,       // everything that fn read is consistent
  kExpired,  // the zone was unloaded before fn was done: discard what it read; reading again may
             // help
  kAbsent,   // the zone is not loaded, or there is no such zone
  kDamaged,  // the memory breaks the format: not written by a working zoned
};
const char* to_string(ReadStatus status) noexcept;

// Reads zones in place in the memory that zoned shares. It takes no lock and cannot hold zoned up:
// a zone may be unloaded at any moment, which read() reports afterwards. A lease (client.hpp) makes
// that unlikely.
//
// Whatever fn reads after the zone was unloaded is wrong but harmless: offsets and counts were
// copied before and are bounded to the slot. Ids, poses, links and calibrations are copies and
// never change. fn must not act on what it reads before read() has returned kOk.
//
// Ownership: refers to memory that stays mapped longer.
// Threads: one at a time; a reader for each thread costs little.
// Memory: what a ZoneGrant takes, for at most kMostGrants zones.
class SharedReader {
 public:
  static constexpr std::size_t kMostGrants = 16;

  // kBadMagic, kBadVersion, kTruncated, kMismatch: not memory that this version can read.
  static Result<SharedReader> open(std::span<const std::byte> memory);

  // Zones of the map in use; they are numbered as in its manifest.
  std::uint32_t zone_count() const noexcept { return tables_.zone_count(); }
  bool resident(ZoneId zone) const noexcept { return state_of(zone) != 0; }

  // Incremented at every start of zoned and every change of map, when zones are renumbered.
  std::uint32_t epoch() const noexcept { return tables_.epoch(); }

  // Calls fn(const ZoneSignatures&) unless the zone is absent. The first read of a zone since it
  // was loaded scans it and allocates; later ones do not. What fn is given is valid until it
  // returns. fn may read other zones.
  template <typename Fn>
  ReadStatus read(ZoneId zone, Fn&& fn) {
    std::shared_ptr<const ZoneGrant> grant;
    if (const ReadStatus found = find(zone, grant); found != ReadStatus::kOk) return found;
    fn(ZoneSignatures(grant->view()));
    return still_valid(*grant) ? ReadStatus::kOk : ReadStatus::kExpired;
  }

  // Frees what was copied from zones.
  void forget_grants() noexcept { grants_.clear(); }

 private:
  struct Held {
    std::shared_ptr<const ZoneGrant> grant;
    std::uint64_t last_used = 0;
  };

  explicit SharedReader(const SharedTables& tables) : tables_(tables) {}
  std::uint64_t state_of(ZoneId zone) const noexcept;
  ReadStatus find(ZoneId zone, std::shared_ptr<const ZoneGrant>& grant);
  bool still_valid(const ZoneGrant& grant) const noexcept;

  SharedTables tables_;
  std::vector<Held> grants_;
  std::uint64_t uses_ = 0;
};

}  // namespace zonepack
