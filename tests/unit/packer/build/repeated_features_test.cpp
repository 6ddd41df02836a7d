// SPDX-License-Identifier: Apache-2.0
#include "packer/build/repeated_features.hpp"

#include <gtest/gtest.h>

namespace zonepack::packer {
namespace {

SignatureRecord with_features(std::int32_t id, float first_x, std::size_t count = 20) {
  SignatureRecord record;
  record.id = id;
  record.features.count = count;
  record.features.x.assign(count, first_x);
  record.features.y.assign(count, 1);
  record.features.descriptors.assign(count * 32, std::byte{7});
  return record;
}

TEST(RepeatedFeatures, AreNamedInAnyOrder) {
  RepeatedFeatures repeated;
  for (const std::int32_t id : {9, 5, 4}) repeated.add(with_features(id, 1));
  repeated.add(with_features(7, 2));
  EXPECT_EQ(repeated.text().value(),
            "signatures 4 and 5 hold the same 20 features, bit for bit, 3 signatures in all");
  repeated.clear();
  EXPECT_FALSE(repeated.text());
}

TEST(RepeatedFeatures, AreNoneWhereOneFeatureDiffersOrFewAreAlike) {
  RepeatedFeatures repeated;
  SignatureRecord other = with_features(2, 1);
  other.features.descriptors.back() = std::byte{8};
  repeated.add(with_features(1, 1));
  repeated.add(other);
  repeated.add(with_features(3, 1, 15));
  repeated.add(with_features(4, 1, 15));
  EXPECT_FALSE(repeated.text());
}

}  // namespace
}  // namespace zonepack::packer
