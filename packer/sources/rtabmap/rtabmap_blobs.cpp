// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_blobs.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "packer/sources/rtabmap/zlib_blob.hpp"
#include "packer/sources/sqlite/cells.hpp"

namespace zonepack::packer {
namespace {

constexpr SchemaVersion kNewLayouts{0, 18, 0};
constexpr SchemaVersion kImageSizeInCalibration{0, 11, 2};
constexpr std::array<std::uint8_t, 13> kScanChannels = {0, 2, 3, 5, 6, 3, 4, 4, 6, 7, 7, 5, 6};
constexpr std::uint32_t kMostChannelsOfUnknownScan = 10;
constexpr std::int32_t kDepthFloat32 = 5;

std::uint32_t float_channels(const Matrix& matrix) {
  if ((matrix.type & 7) != kDepthFloat32) return 0;
  return (static_cast<std::uint32_t>(matrix.type) >> 3) + 1;
}

template <std::size_t N>
std::array<float, N> floats(std::span<const std::byte> bytes) {
  std::array<float, N> values;
  std::memcpy(values.data(), bytes.data(), sizeof(values));
  return values;
}

std::int32_t scan_format(float stored, const CellPlace& place) {
  if (!(stored >= 0 && stored < kScanChannels.size()) || stored != std::floor(stored)) {
    place.damaged("expected a scan format from 0 to 12, found " + std::to_string(stored));
  }
  return static_cast<std::int32_t>(stored);
}

// Reads a calibration from its front to its end.
class Calibration {
 public:
  Calibration(std::span<const std::byte> bytes, const CellPlace& place)
      : rest_(bytes), place_(place) {}

  bool empty() const { return rest_.empty(); }

  void camera() {
    const auto kind = peek_kind();
    if (kind == 0) return mono();
    if (kind == 1) return stereo();
    place_.damaged("expected a camera of kind 0 (mono) or 1 (stereo), found kind " +
                   std::to_string(kind));
  }

  void mono() {
    const auto header = take_header<11>();
    for (const std::int32_t side : {header[4], header[5]}) {
      if (side < 0) place_.damaged("expected an image size, found " + std::to_string(side));
    }
    expect_size(header[6], 9, "K");
    if (header[7] < 0 || header[7] > 14) {
      place_.damaged("expected up to 14 distortion coefficients, found " +
                     std::to_string(header[7]));
    }
    expect_size(header[8], 9, "R");
    expect_size(header[9], 12, "P");
    expect_size(header[10], 12, "local transform");
    const int doubles = header[6] + header[7] + header[8] + header[9];
    take(static_cast<std::size_t>(doubles) * 8 + static_cast<std::size_t>(header[10]) * 4);
  }

 private:
  std::int32_t peek_kind() {
    require(16);
    std::int32_t kind;
    std::memcpy(&kind, rest_.data() + 12, sizeof(kind));
    return kind;
  }

  void stereo() {
    const auto header = take_header<10>();
    expect_size(header[4], 9, "R");
    expect_size(header[5], 3, "T");
    expect_size(header[6], 9, "E");
    expect_size(header[7], 9, "F");
    take(static_cast<std::size_t>(header[4] + header[5] + header[6] + header[7]) * 8);
    for (const std::int32_t side_bytes : {header[8], header[9]}) {
      if (side_bytes < 0) place_.damaged("a stereo camera declares a negative size");
      Calibration side(take(static_cast<std::size_t>(side_bytes)), place_);
      if (side.empty()) continue;
      side.mono();
      if (!side.empty()) place_.damaged("a stereo camera's side is longer than its record");
    }
  }

  void expect_size(std::int32_t found, std::int32_t full, const char* what) const {
    if (found == 0 || found == full) return;
    place_.damaged(std::string("expected 0 or ") + std::to_string(full) + " values of " + what +
                   ", found " + std::to_string(found));
  }

  void require(std::size_t bytes) const {
    if (rest_.size() >= bytes) return;
    place_.damaged("expected " + std::to_string(bytes) + " more bytes of a camera, found " +
                   std::to_string(rest_.size()));
  }

  std::span<const std::byte> take(std::size_t bytes) {
    require(bytes);
    const auto taken = rest_.first(bytes);
    rest_ = rest_.subspan(bytes);
    return taken;
  }

  template <std::size_t N>
  std::array<std::int32_t, N> take_header() {
    std::array<std::int32_t, N> header;
    std::memcpy(header.data(), take(sizeof(header)).data(), sizeof(header));
    return header;
  }

  std::span<const std::byte> rest_;
  const CellPlace& place_;
};

}  // namespace

std::uint32_t scan_channels(std::int32_t format) noexcept {
  if (format < 0 || static_cast<std::size_t>(format) >= kScanChannels.size()) return 0;
  return kScanChannels[static_cast<std::size_t>(format)];
}

void parse_scan_info(std::span<const std::byte> info, SchemaVersion version, const CellPlace& place,
                     Scan& scan) {
  if (info.empty()) return;
  std::size_t fields = 7;
  for (const std::size_t old : {2u, 3u}) {
    if (version < kNewLayouts && info.size() == (old + 12) * sizeof(float)) fields = old;
  }
  expect_elements(info, fields + 12, sizeof(float), "float32", place);
  const auto local = transform_from(info.subspan(fields * sizeof(float)), place);
  scan.local_transform = local.value_or(Transform{});
  if (fields == 7) {
    const auto f = floats<7>(info);
    scan.format = scan_format(f[0], place);
    scan.range_min = f[1];
    scan.range_max = f[2];
    scan.angle_min = f[3];
    scan.angle_max = f[4];
    scan.angle_increment = f[5];
    scan.max_points = f[6];
    return;
  }
  const auto f = floats<2>(info);
  scan.max_points = f[0];
  scan.range_max = f[1];
  if (fields == 3) scan.format = scan_format(floats<3>(info)[2], place);
}

void check_scan(const Scan& scan, const CellPlace& place) {
  const std::uint32_t found = float_channels(scan.data);
  const std::uint32_t expected = scan_channels(scan.format);
  const bool right =
      expected != 0 ? found == expected : found >= 1 && found <= kMostChannelsOfUnknownScan;
  if (right) return;
  place.damaged("expected " +
                (expected != 0 ? std::to_string(expected) + " x float32 for scan format " +
                                     std::to_string(scan.format)
                               : std::string("1 to 10 x float32 for a scan of no stated format")) +
                ", found " + describe_type(scan.data.type));
}

void check_grid_cells(const Matrix& cells, const CellPlace& place) {
  const std::uint32_t found = float_channels(cells);
  if (found == 2 || found == 3 || found == 4 || found == 6) return;
  place.damaged("expected cells of 2, 3, 4 or 6 x float32, found " + describe_type(cells.type));
}

void check_calibration(std::span<const std::byte> bytes, SchemaVersion version,
                       const CellPlace& place) {
  if (version < kNewLayouts && bytes.size() % sizeof(float) == 0) {
    const std::size_t per_camera = version < kImageSizeInCalibration ? 16 : 18;
    const std::size_t count = bytes.size() / sizeof(float);
    if (count % per_camera == 0 || count == 19 || count == 17) return;
  }
  Calibration rest(bytes, place);
  while (!rest.empty()) rest.camera();
}

}  // namespace zonepack::packer
