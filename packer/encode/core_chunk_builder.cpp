// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/core_chunk_builder.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include "packer/encode/format_limit.hpp"
#include "platform/base/require.hpp"
#include "runtime/pack_format/core_chunk_generated.h"
#include "runtime/pack_format/limits.hpp"

namespace zonepack::packer {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
constexpr std::uint64_t kCoreFrameBytes = 160;
constexpr std::uint64_t kTableBytes = 288;  // a Signature with every field, its vtable and padding

const fb::Transform* to_struct(const std::optional<Transform>& transform) {
  static_assert(sizeof(fb::Transform) == sizeof(Transform));
  return transform ? reinterpret_cast<const fb::Transform*>(transform->data()) : nullptr;
}

std::uint64_t bound_of(const SignatureRecord& record) {
  std::uint64_t bound = kTableBytes + record.label.size() + record.velocity.size() +
                        record.gps.size() + record.env_sensors.size();
  if (!record.calibration.empty()) bound += record.calibration.size() + 24;
  for (const Link& link : record.links) {
    bound += sizeof(fb::Link) + (link.information.empty() ? 0 : sizeof(fb::Information));
  }
  return bound;
}

void check_length(const SignatureRecord& record, const char* column, std::size_t size) {
  require_within(LimitId::kCoreBlobBytes, size,
                 "signature " + std::to_string(record.id) + ", " + column);
}

// Any fixed order will do, since indices follow the order of insertion.
struct ByLengthThenBits {
  bool operator()(const Bytes& a, const Bytes& b) const {
    if (a.size() != b.size()) return a.size() < b.size();
    return !a.empty() && std::memcmp(a.data(), b.data(), a.size()) < 0;
  }
};

// Gives each distinct value of a run one index.
class Interned {
 public:
  std::uint32_t place_of(const Bytes& key) {
    const auto [found, inserted] =
        places_.emplace(key, static_cast<std::uint32_t>(in_order_.size()));
    if (inserted) in_order_.push_back(&found->first);
    return found->second;
  }
  const std::vector<const Bytes*>& in_order() const { return in_order_; }

 private:
  std::map<Bytes, std::uint32_t, ByLengthThenBits> places_;
  std::vector<const Bytes*> in_order_;
};

// Matrices are compared by their bits, so that NaN and -0 are restored exactly.
Bytes bits_of(const std::vector<double>& matrix) {
  const auto bytes = std::as_bytes(std::span(matrix));
  return {bytes.begin(), bytes.end()};
}

using ByteVector = flatbuffers::Offset<flatbuffers::Vector<std::uint8_t>>;

ByteVector bytes_vector(flatbuffers::FlatBufferBuilder& builder, const Bytes& bytes) {
  if (bytes.empty()) return 0;
  return builder.CreateVector(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

}  // namespace

std::vector<CoreRecord> core_records(SignatureRecord& record, std::uint32_t ordinal) {
  check_length(record, "Node.label", record.label.size());
  check_length(record, "Node.velocity", record.velocity.size());
  check_length(record, "Node.gps", record.gps.size());
  check_length(record, "Node.env_sensors", record.env_sensors.size());
  check_length(record, "Data.calibration", record.calibration.size());

  CoreRecord core;
  core.ordinal = ordinal;
  core.record.id = record.id;
  core.record.map_id = record.map_id;
  core.record.weight = record.weight;
  core.record.stamp = record.stamp;
  core.record.label = std::move(record.label);
  core.record.pose = record.pose;
  core.record.odometry_pose = record.odometry_pose;
  core.record.ground_truth_pose = record.ground_truth_pose;
  core.record.velocity = std::move(record.velocity);
  core.record.gps = std::move(record.gps);
  core.record.env_sensors = std::move(record.env_sensors);
  core.record.calibration = std::move(record.calibration);
  std::vector<CoreRecord> records;
  records.push_back(std::move(core));
  for (std::size_t i = 0; i < record.links.size(); ++i) {
    if (i > 0 && i % kLinksPerCoreRecord == 0) {
      CoreRecord more;
      more.ordinal = ordinal;
      more.continued = true;
      records.push_back(std::move(more));
    }
    records.back().record.links.push_back(std::move(record.links[i]));
  }
  for (CoreRecord& part : records) part.size_bound = bound_of(part.record);
  return records;
}

std::size_t core_run(std::span<const CoreRecord> records, std::uint64_t capacity) {
  std::uint64_t size = kCoreFrameBytes;
  std::size_t count = 0;
  // Equal matrices and calibrations are stored once, so the bound counts each only once.
  Interned informations;
  Interned calibrations;
  for (const CoreRecord& core : records) {
    std::uint64_t more = core.size_bound;
    for (const Link& link : core.record.links) {
      if (link.information.empty()) continue;
      const std::size_t before = informations.in_order().size();
      informations.place_of(bits_of(link.information));
      if (informations.in_order().size() == before) more -= sizeof(fb::Information);
    }
    if (!core.record.calibration.empty()) {
      const std::size_t before = calibrations.in_order().size();
      calibrations.place_of(core.record.calibration);
      if (calibrations.in_order().size() == before) more -= core.record.calibration.size() + 24;
    }
    if (size + more > capacity) break;
    size += more;
    ++count;
  }
  return count;
}

Bytes build_core_chunk(std::span<const CoreRecord> records) {
  flatbuffers::FlatBufferBuilder builder(kSlotBytes);
  Interned informations;
  Interned calibrations;
  std::vector<flatbuffers::Offset<fb::Signature>> signatures;
  for (const CoreRecord& core : records) {
    const SignatureRecord& record = core.record;
    std::vector<fb::Link> links;
    for (const Link& link : record.links) {
      const std::uint32_t place =
          link.information.empty() ? kNone : informations.place_of(bits_of(link.information));
      const fb::Transform none{};
      const fb::Transform* const transform = to_struct(link.transform);
      links.emplace_back(link.to, link.type, place, link.transform ? 1 : 0,
                         transform == nullptr ? none : *transform);
    }
    const auto label = record.label.empty() ? 0 : builder.CreateString(record.label);
    const auto velocity = bytes_vector(builder, record.velocity);
    const auto gps = bytes_vector(builder, record.gps);
    const auto env = bytes_vector(builder, record.env_sensors);
    const auto link_vector = links.empty() ? 0 : builder.CreateVectorOfStructs(links);
    signatures.push_back(fb::CreateSignature(
        builder, core.continued, record.id, record.map_id, record.weight,
        record.calibration.empty() ? kNone : calibrations.place_of(record.calibration),
        record.stamp, label, to_struct(record.pose), to_struct(record.odometry_pose),
        to_struct(record.ground_truth_pose), velocity, gps, env, link_vector));
  }
  std::vector<fb::Information> matrices(informations.in_order().size());
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    std::memcpy(&matrices[i], informations.in_order()[i]->data(), sizeof matrices[i]);
  }
  std::vector<flatbuffers::Offset<fb::Calibration>> blobs;
  for (const Bytes* blob : calibrations.in_order()) {
    blobs.push_back(fb::CreateCalibration(builder, bytes_vector(builder, *blob)));
  }
  const auto information_vector = matrices.empty() ? 0 : builder.CreateVectorOfStructs(matrices);
  const auto calibration_vector = blobs.empty() ? 0 : builder.CreateVector(blobs);
  const auto signature_vector = builder.CreateVector(signatures);
  fb::FinishCoreChunkBuffer(builder,
                            fb::CreateCoreChunk(builder, records.front().ordinal, signature_vector,
                                                information_vector, calibration_vector));
  const auto* const begin = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  return {begin, begin + builder.GetSize()};
}

}  // namespace zonepack::packer
