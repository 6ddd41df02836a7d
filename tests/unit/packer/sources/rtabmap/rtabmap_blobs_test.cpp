// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_blobs.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/blob_writer.hpp"
#include "tests/support/signature_recipe.hpp"

namespace zonepack::packer {
namespace {

using test_support::bytes_of;
using test_support::level_pose;

const std::string kBlobDatabase = "map.db";
const CellPlace kNode{.file = &kBlobDatabase, .signature = 7, .column = "Data.scan_info"};

std::vector<float> with_local(std::vector<float> values) {
  const Transform local = level_pose(1, 2, 3);
  values.insert(values.end(), local.begin(), local.end());
  return values;
}

TEST(ScanFormats, HaveTheChannelsOfTheirPoints) {
  EXPECT_EQ(scan_channels(1), 2u);   // XY
  EXPECT_EQ(scan_channels(2), 3u);   // XY, intensity
  EXPECT_EQ(scan_channels(3), 5u);   // XY, normal
  EXPECT_EQ(scan_channels(4), 6u);   // XY, intensity, normal
  EXPECT_EQ(scan_channels(5), 3u);   // XYZ
  EXPECT_EQ(scan_channels(6), 4u);   // XYZ, intensity
  EXPECT_EQ(scan_channels(7), 4u);   // XYZ, packed colour
  EXPECT_EQ(scan_channels(8), 6u);   // XYZ, normal
  EXPECT_EQ(scan_channels(9), 7u);   // XYZ, intensity, normal
  EXPECT_EQ(scan_channels(10), 7u);  // XYZ, packed colour, normal
  EXPECT_EQ(scan_channels(11), 5u);  // XYZ, intensity, time
  EXPECT_EQ(scan_channels(12), 6u);  // XYZ, intensity, ring, time
  for (const std::int32_t none : {-1, 0, 13, 1000}) EXPECT_EQ(scan_channels(none), 0u);
}

TEST(ScanInfo, OfEveryVersionIsTakenApart) {
  Scan scan;
  parse_scan_info(bytes_of(with_local({6, 0.5f, 30, -3, 3, 0.25f, 900})), {0, 18, 0}, kNode, scan);
  EXPECT_EQ(scan.format, 6);
  EXPECT_EQ(scan.range_min, 0.5f);
  EXPECT_EQ(scan.range_max, 30);
  EXPECT_EQ(scan.angle_min, -3);
  EXPECT_EQ(scan.angle_max, 3);
  EXPECT_EQ(scan.angle_increment, 0.25f);
  EXPECT_EQ(scan.max_points, 900);
  EXPECT_EQ(scan.local_transform, level_pose(1, 2, 3));

  Scan with_format;
  parse_scan_info(bytes_of(with_local({360, 25, 5})), {0, 16, 1}, kNode, with_format);
  EXPECT_EQ(with_format.format, 5);
  EXPECT_EQ(with_format.range_max, 25);
  EXPECT_EQ(with_format.max_points, 360);
  EXPECT_EQ(with_format.local_transform, level_pose(1, 2, 3));

  Scan without_format;
  parse_scan_info(bytes_of(with_local({360, 25})), {0, 11, 10}, kNode, without_format);
  EXPECT_EQ(without_format.format, 0);
  EXPECT_EQ(without_format.max_points, 360);
  EXPECT_EQ(without_format.local_transform, level_pose(1, 2, 3));
}

TEST(ScanInfo, OfNoScanLeavesTheFormatOpen) {
  Scan scan;
  parse_scan_info({}, {0, 23, 8}, kNode, scan);
  EXPECT_EQ(scan.format, 0);
  EXPECT_EQ(scan.local_transform, Transform{});
}

}  // namespace
}  // namespace zonepack::packer
