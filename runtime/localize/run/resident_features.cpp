// SPDX-License-Identifier: Apache-2.0
#include "runtime/localize/run/resident_features.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "runtime/localize/query/localizer.hpp"

namespace zonepack::localize {
namespace {

Eigen::Isometry3d transform_of(const RigidTransform& from) {
  Eigen::Isometry3d to = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      to.matrix()(row, column) =
          static_cast<double>(from[static_cast<std::size_t>(4) * static_cast<std::size_t>(row) +
                                   static_cast<std::size_t>(column)]);
    }
  }
  return to;
}

}  // namespace

std::size_t ResidentFeatures::signatures_held() const noexcept {
  std::size_t held = 0;
  for (const Zone& zone : zones_) {
    for (const Entry& entry : zone.entries) held += entry.features != nullptr ? 1 : 0;
  }
  return held;
}

// Where the zone's signatures are; false when it cannot be read now.
bool ResidentFeatures::list(ZonesInMemory& zones, ZoneId id, Zone& zone) {
  if (zone.listed) return true;
  std::vector<Entry> entries;
  const ReadStatus status = zones.read(id, [&](const ZoneSignatures& signatures) {
    entries.reserve(signatures.size());
    for (std::uint32_t i = 0; i < signatures.size(); ++i) {
      if (const auto pose = signatures[i].T_map_base()) {
        entries.push_back({transform_of(*pose), i, false, nullptr});
      }
    }
  });
  if (status != ReadStatus::kOk) {
    expired_ += status == ReadStatus::kExpired ? 1 : 0;
    return false;
  }
  zone.entries = std::move(entries);
  return zone.listed = true;
}

// Copies the features that are wanted and missing.
void ResidentFeatures::fetch(ZonesInMemory& zones, ZoneId id, Zone& zone) {
  std::vector<std::pair<Entry*, std::unique_ptr<MapFeatures>>> copied;
  ReadStatus status = ReadStatus::kOk;
  const auto read = [&] {
    copied.clear();
    status = zones.read(id, [&](const ZoneSignatures& signatures) {
      for (Entry& entry : zone.entries) {
        if (!entry.wanted || entry.features != nullptr) continue;
        if (entry.index >= signatures.size()) continue;
        if (auto features = copy_features(signatures[entry.index], id, descriptor_bytes_)) {
          copied.emplace_back(&entry, std::make_unique<MapFeatures>(std::move(*features)));
        }
      }
    });
  };
  // A lease costs two round trips of tens of milliseconds, so only after a read that came too late.
  if (zone.expired) {
    zones.hold(id, read);
  } else {
    read();
  }
  zone.expired = status == ReadStatus::kExpired;
  expired_ += zone.expired ? 1 : 0;
  if (status != ReadStatus::kOk) return;
  for (auto& [entry, features] : copied) entry->features = std::move(features);
}

std::span<const MapFeatures* const> ResidentFeatures::near(ZonesInMemory& zones,
                                                           const QueryPrior& prior) {
  if (zones.epoch() != epoch_ || zones_.size() != zones.zones()) {
    zones_.clear();
    zones_.resize(zones.zones());
    epoch_ = zones.epoch();
  }
  near_.clear();
  for (ZoneId id = 0; id < zones_.size(); ++id) {
    Zone& zone = zones_[id];
    if (!zones.resident(id)) {
      zone = {};
      continue;
    }
    if (!list(zones, id, zone)) continue;
    bool missing = false;
    for (Entry& entry : zone.entries) {
      entry.wanted = in_reach(entry.T_map_base, prior);
      if (!entry.wanted) entry.features.reset();
      missing = missing || (entry.wanted && entry.features == nullptr);
    }
    if (missing) fetch(zones, id, zone);
    for (const Entry& entry : zone.entries) {
      if (entry.features != nullptr) near_.push_back(entry.features.get());
    }
  }
  return near_;
}

}  // namespace zonepack::localize
