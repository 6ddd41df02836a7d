// SPDX-License-Identifier: Apache-2.0
#include "runtime/map/next_version.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/runtime/map/two_zones.hpp"

namespace zonepack {
namespace {

class NextVersion : public testing::Test {
 protected:
  ErrorCode check() { return check(in_use.catalog(), next.catalog()); }
  ErrorCode check(const Catalog& from, const Catalog& to) {
    const Failure failed = check_next_version(from, to, kDefaultReadMode).error();
    fault = failed.message;
    return failed.code;
  }
  bool names(const std::string& text) const { return fault.find(text) != std::string::npos; }

  const test_support::TwoZones in_use{2};
  const test_support::TwoZones next{3};
  std::string fault;
};

TEST_F(NextVersion, IsTakenWhenEveryPackIsThereWhole) {
  EXPECT_EQ(check(), ErrorCode::kOk) << fault;
  EXPECT_TRUE(fault.empty());
}

TEST_F(NextVersion, IsRefusedByTheNameOfThePackThatIsMissingOrShort) {
  const std::filesystem::path pack = next.pack(1);
  const auto size = std::filesystem::file_size(pack);
  for (const std::uintmax_t left : {size - 1, size / 2, std::uintmax_t{0}}) {
    std::filesystem::resize_file(pack, left);
    EXPECT_EQ(check(), ErrorCode::kTruncated);
    EXPECT_TRUE(names(pack.filename().string())) << fault;
    EXPECT_TRUE(names("zone b")) << fault;
  }
  std::filesystem::remove(pack);
  EXPECT_EQ(check(), ErrorCode::kNotFound);
  EXPECT_TRUE(names("zone b")) << fault;
}

TEST_F(NextVersion, IsRefusedWhenAPackIsAnotherThanTheManifestTellsOf) {
  std::filesystem::copy_file(next.pack(0), next.pack(1),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_NE(check(), ErrorCode::kOk);
  EXPECT_TRUE(names(next.pack(1).filename().string())) << fault;
}

TEST_F(NextVersion, IsNotTheVersionInUseAndNoOtherMap) {
  EXPECT_EQ(check(next.catalog(), next.catalog()), ErrorCode::kExists);
  Catalog other = next.catalog();
  other.lineage[0] ^= 1;
  EXPECT_EQ(check(in_use.catalog(), other), ErrorCode::kMismatch);
  EXPECT_TRUE(names("manifest.zpm")) << fault;
}

}  // namespace
}  // namespace zonepack
