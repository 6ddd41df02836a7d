// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "runtime/client/shared_reader.hpp"
#include "runtime/localize/query/map_features.hpp"
#include "runtime/localize/query/query_result.hpp"

namespace zonepack::localize {

// The zones in zoned's memory, as ResidentFeatures reads them.
class ZonesInMemory {
 public:
  using Fn = std::function<void(const ZoneSignatures&)>;
  virtual ~ZonesInMemory() = default;
  virtual std::uint32_t epoch() const noexcept = 0;  // changes with the numbers of zones
  virtual std::uint32_t zones() const noexcept = 0;
  virtual bool resident(ZoneId zone) const noexcept = 0;
  virtual ReadStatus read(ZoneId zone, const Fn& fn) = 0;
  // Keeps a zone from being unloaded for a moment, if zoned can; then fn() and no longer.
  virtual void hold(ZoneId zone, const std::function<void()>& fn) = 0;
};

// Features of the signatures that a query can use: of zones that are resident now, within reach of
// where the robot is thought to be. They are copied once from zoned's memory, checked to have been
// there all the while, and forgotten when the robot leaves or the zone is unloaded: with a map's
// numbers, a signature never changes.
//
// Memory: the features in reach, and 128 bytes for each signature of a resident zone.
// Threads: one.
class ResidentFeatures {
 public:
  explicit ResidentFeatures(std::uint32_t descriptor_bytes) : descriptor_bytes_(descriptor_bytes) {}

  // Valid until the next call.
  std::span<const MapFeatures* const> near(ZonesInMemory& zones, const QueryPrior& prior);

  // Gives the memory back, while nothing is near anything: the robot is lost.
  void forget() noexcept {
    zones_.clear();
    near_.clear();
  }

  std::size_t signatures_held() const noexcept;
  // Reads that found their zone unloaded half-way.
  std::uint64_t expired() const noexcept { return expired_; }

 private:
  struct Entry {
    Eigen::Isometry3d T_map_base;
    std::uint32_t index = 0;  // in the zone
    bool wanted = false;
    std::unique_ptr<MapFeatures> features;  // null: not in reach, or not copied yet
  };
  struct Zone {
    bool listed = false;
    bool expired = false;  // at the last try
    std::vector<Entry> entries;
  };

  bool list(ZonesInMemory& zones, ZoneId id, Zone& zone);
  void fetch(ZonesInMemory& zones, ZoneId id, Zone& zone);

  const std::uint32_t descriptor_bytes_;
  std::uint32_t epoch_ = 0;
  std::vector<Zone> zones_;
  std::vector<const MapFeatures*> near_;
  std::uint64_t expired_ = 0;
};

}  // namespace zonepack::localize
