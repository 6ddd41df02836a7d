// SPDX-License-Identifier: Apache-2.0
// Every kind of damage inside one signature names the signature and the column, and spares the
// rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "damaged_signatures.hpp"
#include "packer/sources/rtabmap/rtabmap_database.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::packer {
namespace {

using test_support::bytes_of;
using test_support::execute;
using test_support::first_difference;
using test_support::float_matrix;
using test_support::zip;
using ::testing::HasSubstr;

Bytes cut(const Bytes& bytes, std::ptrdiff_t from_end) {
  return {bytes.begin(), bytes.end() - from_end};
}

Bytes flipped(Bytes bytes, std::size_t at) {
  bytes[at] ^= std::byte{0x40};
  return bytes;
}

Bytes scan_info(float format) {
  Bytes info = numbers(19, format);
  return info;
}

Bytes text_bytes(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  return {bytes.begin(), bytes.end()};
}

// A matrix blob whose trailer does not match its stream.
Bytes lying(std::int32_t rows, std::int32_t cols, std::int32_t type) {
  Bytes blob = cut(zip(float_matrix(1, 4, 2, std::vector<float>(8, 1.0f))), 12);
  const Bytes trailer = bytes_of(std::vector<std::int32_t>{rows, cols, type});
  blob.insert(blob.end(), trailer.begin(), trailer.end());
  return blob;
}

constexpr std::ptrdiff_t kTrailerBytes = 12;

// The same trailer after a stream without its last six bytes, and after one with three more.
Bytes cut_stream(const Bytes& blob) {
  Bytes shorter(blob.begin(), blob.end() - kTrailerBytes - 6);
  shorter.insert(shorter.end(), blob.end() - kTrailerBytes, blob.end());
  return shorter;
}

Bytes with_bytes_after_stream(const Bytes& blob) {
  Bytes longer = blob;
  longer.insert(longer.end() - kTrailerBytes, 3, std::byte{1});
  return longer;
}

// A camera's header of 11 int32, then zeros.
Bytes mono_header(const std::vector<std::int32_t>& header, std::size_t body_bytes) {
  Bytes bytes(header.size() * sizeof(std::int32_t) + body_bytes, std::byte{0});
  std::memcpy(bytes.data(), header.data(), header.size() * sizeof(std::int32_t));
  return bytes;
}

struct Damaged {
  std::string name, sql;
  Bytes blob;
  std::string column, problem;
};

void PrintTo(const Damaged& damage, std::ostream* out) { *out << damage.name; }

std::vector<Damaged> all_damages() {
  const Bytes points = zip(float_matrix(1, 60, 2, std::vector<float>(120, 1.5f)));
  const auto set = [](const std::string& column) {
    return "UPDATE Data SET " + column + "=?1 WHERE id=2";
  };
  const auto node = [](const std::string& value) {
    return "UPDATE Node SET " + value + " WHERE id=2";
  };
  const auto feature = [](const std::string& value) {
    return "UPDATE Feature SET " + value +
           " WHERE rowid=(SELECT max(rowid) FROM Feature WHERE node_id=2)";
  };
  const auto link = [](const std::string& value) {
    return "UPDATE Link SET " + value + " WHERE from_id=2";
  };
  const Bytes depth = test_support::rvl(16, 12, std::vector<std::uint16_t>(192, 1234));
  const Bytes camera = test_support::mono_camera(640, 480, 385, test_support::level_pose(0, 0));
  const Bytes stereo =
      test_support::stereo_camera(640, 480, 385, 0.1, test_support::level_pose(0, 0));
  return {
      {"ScanZlibFlipped", set("scan"), flipped(points, 9), "Data.scan", "zlib stream"},
      {"ScanShorterThanDeclared", set("scan"), lying(1, 5, 13), "Data.scan",
       "(40 bytes), found a zlib stream of 32 bytes"},
      {"ScanCutShort", set("scan"), cut_stream(points), "Data.scan", "cut short"},
      {"ScanThenOtherBytes", set("scan"), with_bytes_after_stream(points), "Data.scan",
       "and 3 bytes after it"},
      {"ScanLongerThanDeclared", set("scan"), lying(1, 3, 13), "Data.scan", "longer"},
      {"ScanTrailerOnly", set("scan"), Bytes(12, std::byte{1}), "Data.scan", "12 bytes"},
      {"ScanNegativeRows", set("scan"), lying(-1, 4, 13), "Data.scan", "found -1 x 4"},
      {"ScanUnknownType", set("scan"), lying(1, 4, 7), "Data.scan", "unknown type 7"},
      {"ScanOverTheLimit", set("scan"), lying(2000000000, 2000000000, 13), "Data.scan",
       "over the limit"},
      {"ScanMoreThanZlibCanHold", set("scan"), lying(1, 10000, 13), "Data.scan",
       "zipped bytes can hold"},
      {"ScanWrongChannels", set("scan_info"), scan_info(5), "Data.scan",
       "expected 3 x float32 for scan format 5, found 2 x float32"},
      {"ScanNotFloat", set("scan"), zip(Matrix{1, 4, 8 + 3, Bytes(16)}), "Data.scan",
       "found 2 x int16"},
      {"ScanInfoShort", set("scan_info"), numbers(18), "Data.scan_info",
       "expected 76 bytes (19 float32), found 72"},
      {"ScanFormatUnknown", set("scan_info"), scan_info(13), "Data.scan_info", "from 0 to 12"},
      {"ScanFormatHalf", set("scan_info"), scan_info(1.5f), "Data.scan_info", "from 0 to 12"},
      {"ScanFormatNan", set("scan_info"), scan_info(kNan), "Data.scan_info", "from 0 to 12"},
      {"ScanIsText",
       "UPDATE Data SET scan='points' WHERE id=2",
       {},
       "Data.scan",
       "expected a blob, found text"},
      {"GridZlibFlipped", set("empty_cells"), flipped(points, 9), "Data.empty_cells",
       "zlib stream"},
      {"GridFiveChannels", set("ground_cells"),
       zip(float_matrix(1, 2, 5, std::vector<float>(10, 1.0f))), "Data.ground_cells",
       "2, 3, 4 or 6"},
      {"GridNotFloat", set("obstacle_cells"), zip(Matrix{1, 4, 8, Bytes(8)}), "Data.obstacle_cells",
       "found 2 x uint8"},
      {"CellSizeTooLarge",
       "UPDATE Data SET cell_size=(1<<62)*1.0*(1<<62)*(1<<62) WHERE id=2",  // 2^186
       {},
       "Data.cell_size",
       "expected a number that a float32 can hold, found 9.807971461541689e+55"},
      {"ViewPointText",
       "UPDATE Data SET view_point_z='up' WHERE id=2",
       {},
       "Data.view_point_z",
       "expected a number, found text"},
      {"ImageUnknown", set("image"), text_bytes("GIF89a......"), "Data.image", "JPEG or PNG"},
      {"ImageIsRvl", set("image"), depth, "Data.image", "JPEG or PNG"},
      {"DepthUnknown", set("depth"), text_bytes("DEPTHXYZ........"), "Data.depth", "depth image"},
      {"DepthNameOnly", set("depth"), text_bytes("DEPTHRVL"), "Data.depth", "depth image"},
      {"DepthConfidence", set("depth_confidence"), text_bytes("not a zlib stream at all"),
       "Data.depth_confidence", "OpenCV type"},
      {"CalibrationKind", set("calibration"),
       mono_header({0, 23, 8, 2, 640, 480, 0, 0, 0, 0, 0}, 0), "Data.calibration", "found kind 2"},
      {"CalibrationShort", set("calibration"), cut(camera, 1), "Data.calibration",
       "more bytes of a camera"},
      {"CalibrationLong", set("calibration"),
       mono_header({0, 23, 8, 0, 640, 480, 0, 0, 0, 0, 0}, 4), "Data.calibration",
       "more bytes of a camera"},
      {"CalibrationTenK", set("calibration"),
       mono_header({0, 23, 8, 0, 640, 480, 10, 0, 0, 0, 0}, 80), "Data.calibration",
       "0 or 9 values of K"},
      {"CalibrationHugeD", set("calibration"),
       mono_header({0, 23, 8, 0, 640, 480, 9, 1 << 30, 0, 0, 0}, 72), "Data.calibration",
       "distortion"},
      {"CalibrationNegativeSize", set("calibration"),
       mono_header({0, 23, 8, 0, -640, 480, 0, 0, 0, 0, 0}, 0), "Data.calibration", "image size"},
      {"CalibrationStereoCut", set("calibration"), cut(stereo, 8), "Data.calibration",
       "more bytes of a camera"},
      {"UserData", set("user_data"), flipped(points, 3), "Data.user_data", "zlib stream"},
      {"PoseShort", node("pose=?1"), numbers(11), "Node.pose",
       "expected 48 bytes (12 float32), found 44"},
      {"PoseNan", node("pose=?1"), numbers(12, kNan), "Node.pose", "NaN"},
      {"GroundTruthNan", node("ground_truth_pose=?1"), numbers(12, kNan), "Node.ground_truth_pose",
       "NaN"},
      {"Velocity", node("velocity=?1"), numbers(5), "Node.velocity", "expected 24 bytes"},
      {"Gps", node("gps=?1"), numbers(6), "Node.gps", "expected 48 bytes (6 float64), found 24"},
      {"EnvSensors", node("env_sensors=?1"), numbers(8), "Node.env_sensors", "float64), found 32"},
      {"StampText", node("stamp='noon'"), {}, "Node.stamp", "expected a number"},
      {"StampInfinite", node("stamp=9e999"), {}, "Node.stamp", "finite"},
      {"LabelBlob", node("label=?1"), numbers(2), "Node.label", "expected text"},
      {"LabelNotUtf8", node("label=CAST(x'c328' AS TEXT)"), {}, "Node.label", "UTF-8"},
      {"MapIdHuge", node("map_id=5000000000"), {}, "Node.map_id", "32 bits, found 5000000000"},
      {"WeightReal", node("weight=0.5"), {}, "Node.weight", "expected an integer"},
      {"WordIdText",
       feature("word_id='a'"),
       {},
       "Feature.word_id",
       "expected an integer, found text"},
      {"PositionTooLarge", feature("pos_y=1e39"), {}, "Feature.pos_y", "float32"},
      {"PointText",
       feature("depth_z='far'"),
       {},
       "Feature.depth_z",
       "expected a number, found text"},
      {"OctaveReal", feature("octave=1.5"), {}, "Feature.octave", "expected an integer"},
      {"DescriptorShort",
       feature("descriptor=x'0102'"),
       {},
       "Feature.descriptor",
       "expected 32 bytes or float32, found 2 bytes"},
      {"DescriptorMixedSize",
       feature("descriptor=x'0102', descriptor_size=2"),
       {},
       "Feature.descriptor",
       "found 32 bytes and 2 bytes"},
      {"DescriptorMixedKind", feature("descriptor=?1"), Bytes(128), "Feature.descriptor",
       "found 32 bytes and 32 float32"},
      {"DescriptorMissing",
       feature("descriptor=NULL"),
       {},
       "Feature.descriptor",
       "found 32 bytes and none"},
      {"DescriptorText", feature("descriptor='abc'"), {}, "Feature.descriptor", "expected a blob"},
      {"InformationShort", link("information_matrix=?1"), Bytes(280, std::byte{1}),
       "Link.information_matrix", "expected 288 bytes (36 float64), found 280"},
      {"LinkTransformShort", link("transform=?1"), numbers(10), "Link.transform",
       "expected 48 bytes"},
      {"LinkTransformNan", link("transform=?1"), numbers(12, kNan), "Link.transform", "NaN"},
      {"LinkTypeText", link("type='loop'"), {}, "Link.type", "expected an integer"},
      {"LinkToHuge", link("to_id=5000000000"), {}, "Link.to_id", "32 bits"},
      {"LinkUserData", link("user_data=?1"), Bytes(30, std::byte{1}), "Link.user_data", "expected"},
      {"GlobalDescriptorData", "UPDATE GlobalDescriptor SET data=?1 WHERE node_id=2",
       flipped(points, 9), "GlobalDescriptor.data", "zlib stream"},
      {"GlobalDescriptorInfo", "UPDATE GlobalDescriptor SET info=?1 WHERE node_id=2",
       Bytes(5, std::byte{1}), "GlobalDescriptor.info", "compressed matrix"},
      {"GlobalDescriptorType",
       "UPDATE GlobalDescriptor SET type='x' WHERE node_id=2",
       {},
       "GlobalDescriptor.type",
       "integer"},
  };
}

class DamageOfOneSignature : public ::testing::TestWithParam<Damaged> {};

TEST_P(DamageOfOneSignature, IsNamedAndSparesTheOthers) {
  const Damaged& damage = GetParam();
  const test_support::TemporaryFolder folder;
  const auto path = folder / "map.db";
  write_rtabmap_database(path, three_signatures());
  execute(path, damage.sql, damage.blob);

  RtabmapDatabase database(path);
  SignatureRecord record;
  database.read(1, PayloadSet(), record);
  try {
    database.read(2, PayloadSet(), record);
    FAIL() << "read a damaged signature";
  } catch (const DamagedSignature& error) {
    EXPECT_EQ(error.damage().signature, 2);
    EXPECT_EQ(error.damage().column, damage.column);
    EXPECT_THAT(error.damage().problem, HasSubstr(damage.problem));
    EXPECT_THAT(error.what(), HasSubstr("map.db: signature 2 is damaged: " + damage.column));
  }
  // The same object, and the same record, go on with the next one.
  database.read(3, PayloadSet(), record);
  EXPECT_EQ(first_difference(record, three_signatures().signatures[2]), "");
}

INSTANTIATE_TEST_SUITE_P(All, DamageOfOneSignature, ::testing::ValuesIn(all_damages()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace zonepack::packer
