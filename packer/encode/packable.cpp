// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/packable.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "packer/encode/core_chunk_builder.hpp"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

// A row and what a chunk holds besides, at their largest: the other columns of a feature, the
// record, the frame.
constexpr std::uint64_t kMaxRowBytes = kSlotBytes - 1024;
constexpr std::size_t kMaxTables = 1u << 16;  // a record counts tables of a part in 16 bits

std::string too_long(std::uint64_t size, std::uint64_t most) {
  return "has " + std::to_string(size) + " bytes; a pack holds at most " + std::to_string(most) +
         " there";
}

std::optional<Unpackable> long_blob(const SignatureRecord& record) {
  const std::pair<const char*, std::size_t> blobs[] = {
      {"Node.label", record.label.size()},
      {"Node.velocity", record.velocity.size()},
      {"Node.gps", record.gps.size()},
      {"Node.env_sensors", record.env_sensors.size()},
      {"Data.calibration", record.calibration.size()}};
  for (const auto& [column, size] : blobs) {
    if (is_over(LimitId::kCoreBlobBytes, size)) {
      return Unpackable{column, to_string(Excess{LimitId::kCoreBlobBytes, size})};
    }
  }
  return std::nullopt;
}

std::optional<Unpackable> long_core(const SignatureRecord& record) {
  SignatureRecord core;
  core.label = record.label;
  core.velocity = record.velocity;
  core.gps = record.gps;
  core.env_sensors = record.env_sensors;
  core.calibration = record.calibration;
  core.links.assign(record.links.begin(),
                    record.links.begin() + static_cast<std::ptrdiff_t>(
                                               std::min(record.links.size(), kLinksPerCoreRecord)));
  for (Link& link : core.links) link.user_data.reset();
  const std::vector<CoreRecord> records = core_records(core, 0);
  if (core_run(std::span(records).first(1), kSlotBytes) == 1) return std::nullopt;
  return Unpackable{"Node", "its label, sensors, calibration and first links together need over " +
                                std::to_string(kSlotBytes) + " bytes, more than a slot holds"};
}

}  // namespace

std::optional<Unpackable> find_unpackable(const SignatureRecord& record) {
  if (auto problem = long_blob(record)) return problem;
  if (record.label.size() + record.env_sensors.size() + record.calibration.size() > 1024) {
    if (auto problem = long_core(record)) return problem;
  }
  const Features& features = record.features;
  const std::uint64_t descriptor =
      std::uint64_t{features.descriptor_dim} *
      (features.descriptor_type == Features::DescriptorType::kF32 ? 4 : 1);
  if (descriptor > kMaxRowBytes) {
    return Unpackable{"Feature.descriptor", too_long(descriptor, kMaxRowBytes)};
  }
  if (record.global_descriptors.size() > kMaxTables) {
    return Unpackable{"GlobalDescriptor", "has " +
                                              std::to_string(record.global_descriptors.size()) +
                                              " rows; a pack holds at most 65536"};
  }
  for (const GlobalDescriptor& global : record.global_descriptors) {
    const std::uint64_t info = global.info ? global.info->data.size() : 0;
    if (info > kMaxRowBytes) {
      return Unpackable{"GlobalDescriptor.info", too_long(info, kMaxRowBytes)};
    }
  }
  for (std::size_t i = kMaxTables; i < record.links.size(); ++i) {
    if (record.links[i].user_data) {
      return Unpackable{"Link.user_data", "belongs to link " + std::to_string(i + 1) +
                                              "; a pack holds user data of the first 65536"};
    }
  }
  return std::nullopt;
}

}  // namespace zonepack::packer
