// SPDX-License-Identifier: Apache-2.0
#include "packer/build/repeated_features.hpp"

#include <algorithm>
#include <span>

namespace zonepack::packer {
namespace {

// FNV-1a, 64 bits.
std::uint64_t hashed(std::span<const std::byte> bytes, std::uint64_t hash) {
  for (const std::byte byte : bytes) {
    hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001B3;
  }
  return hash;
}

}  // namespace

void RepeatedFeatures::add(const SignatureRecord& record) {
  const Features& features = record.features;
  if (features.count < kLeast) return;
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const std::vector<float>* column : {&features.x, &features.y, &features.point_z}) {
    hash = hashed(std::as_bytes(std::span(*column)), hash);
  }
  hash = hashed(features.descriptors, hash);
  const std::lock_guard lock(mutex_);
  by_content_[{features.count, hash}].push_back(record.id);
}

void RepeatedFeatures::clear() {
  const std::lock_guard lock(mutex_);
  by_content_.clear();
}

std::optional<std::string> RepeatedFeatures::text() const {
  const std::lock_guard lock(mutex_);
  std::size_t groups = 0;
  std::vector<std::int32_t> first;
  std::size_t features = 0;
  for (const auto& [content, ids] : by_content_) {
    if (ids.size() < 2) continue;
    ++groups;
    std::vector<std::int32_t> sorted = ids;
    std::ranges::sort(sorted);
    if (!first.empty() && first.front() <= sorted.front()) continue;
    first = std::move(sorted);
    features = content.first;
  }
  if (groups == 0) return std::nullopt;
  std::string text = "signatures " + std::to_string(first[0]) + " and " + std::to_string(first[1]) +
                     " hold the same " + std::to_string(features) + " features, bit for bit";
  if (first.size() > 2) text += ", " + std::to_string(first.size()) + " signatures in all";
  if (groups > 1) text += "; such groups in all: " + std::to_string(groups);
  return text;
}

}  // namespace zonepack::packer
