// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "packer/record/record.hpp"

// Writers of the blobs that RTAB-Map stores, for databases made by tests.
namespace zonepack::test_support {

using packer::Bytes;

// The bytes of plain values in sequence, as in memory.
template <typename T>
Bytes bytes_of(std::span<const T> values) {
  const auto bytes = std::as_bytes(values);
  return {bytes.begin(), bytes.end()};
}
template <typename T>
Bytes bytes_of(const std::vector<T>& values) {
  return bytes_of(std::span<const T>(values));
}

// A zlib stream, then rows, columns and type.
Bytes zip(const packer::Matrix& matrix);

// OpenCV's number for `channels` of float32.
constexpr std::int32_t float_type(std::int32_t channels) { return 5 + ((channels - 1) << 3); }

packer::Matrix float_matrix(std::int32_t rows, std::int32_t cols, std::int32_t channels,
                            const std::vector<float>& values);

// A whole PNG of one colour type (0 grey, 2 RGB, 6 RGBA); `pixels` is row-major, big-endian where
// the bit depth is 16.
Bytes png(std::uint32_t width, std::uint32_t height, int bit_depth, int colour_type,
          const Bytes& pixels);

// A whole JPEG of one pixel, distinguished from others by its comment.
Bytes jpeg(std::string_view comment);

// "DEPTHRVL", columns, rows, RVL stream.
Bytes rvl(std::uint32_t width, std::uint32_t height, const std::vector<std::uint16_t>& depth_mm);

// Depth as 16-bit PNG of millimetres, and as PNG of the bytes of float32 metres.
Bytes depth_png_16(std::uint32_t width, std::uint32_t height,
                   const std::vector<std::uint16_t>& depth_mm);
Bytes depth_png_float(std::uint32_t width, std::uint32_t height, const std::vector<float>& depth_m);

// One camera of the layout since 0.18, with K, five distortion coefficients, P and local transform.
Bytes mono_camera(std::int32_t width, std::int32_t height, double focal_px,
                  const packer::Transform& T_base_camera);
// A stereo pair of such cameras, with R, T, E and F.
Bytes stereo_camera(std::int32_t width, std::int32_t height, double focal_px, double baseline_m,
                    const packer::Transform& T_base_camera);

}  // namespace zonepack::test_support
