// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "runtime/control/cycle.hpp"
#include "runtime/map/catalog.hpp"
#include "runtime/pack_format/file/accounting.hpp"
#include "tests/support/building.hpp"

// The sample building as a catalog, without packs, and the settings of the robot that drove in it.
namespace zonepack::testing_support {

// Signatures per zone of the small sample map.
inline const std::map<std::string, std::uint32_t>& small_map_signatures() {
  static const std::map<std::string, std::uint32_t> signatures = {
      {"C1", 9},  {"C2", 10}, {"C3", 18}, {"H1", 16}, {"H2", 7},  {"H3", 11},
      {"H4", 3},  {"H5", 2},  {"L1", 31}, {"L2", 5},  {"R11", 8}, {"R12", 8},
      {"R13", 4}, {"R21", 9}, {"R22", 9}, {"R23", 8}, {"R31", 4}, {"R32", 4},
      {"R41", 3}, {"R42", 3}, {"R43", 3}, {"R44", 2}, {"R51", 4}, {"R52", 4}};
  return signatures;
}

// Each signature takes 28,000 bytes decoded and 12,000 stored, about as much as when packed.
inline Catalog sample_catalog(const std::string& zones_file, std::uint32_t times_signatures = 1) {
  const Building building = read_building(zones_file);
  Catalog catalog;
  catalog.folder = "sample";
  for (const GraphZone& zone : building.zones) {
    CatalogZone entry;
    entry.name = zone.name;
    entry.polygon = zone.polygon;
    entry.signatures = small_map_signatures().at(zone.name) * times_signatures;
    entry.decoded_bytes = ByteCount{28'000} * entry.signatures;
    entry.stored_bytes = ByteCount{12'000} * entry.signatures;
    entry.slots = static_cast<std::uint32_t>((entry.decoded_bytes + kSlotBytes - 1) / kSlotBytes);
    catalog.zones.push_back(std::move(entry));
  }
  for (const GraphPortal& portal : building.portals) {
    catalog.portals.push_back({"", portal.zone_a, portal.zone_b, portal.segment});
  }
  catalog.fixed_bytes = 100'000;
  return catalog;
}

// Wheel odometers on CAN id 0x311: int32 mm, big-endian, left in bytes 0 to 3, right in 4 to 7.
inline CycleConfig sample_robot() {
  CycleConfig config;
  CanSignal signal;
  signal.id = 0x311;
  signal.bits = {7, 32, ByteOrder::kBig};
  signal.type = SignalType::kSigned;
  signal.factor = 0.001;
  config.odometry.signals[0] = signal;
  signal.bits.start = 39;
  config.odometry.signals[1] = signal;
  config.odometry.geometry.track_m = 0.413;
  return config;
}

}  // namespace zonepack::testing_support
