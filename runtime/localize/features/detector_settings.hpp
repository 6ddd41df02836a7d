// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "platform/base/failure.hpp"

namespace zonepack::localize {

enum class Detector : std::uint8_t { kGfttOrb, kOrb, kSift, kBrisk };
const char* to_string(Detector detector) noexcept;

// What finds features in an image, so that they are those of the map: the detector and settings of
// its source (a manifest's provenance, FORMAT.md). Defaults are RTAB-Map's.
struct DetectorSettings {
  Detector detector = Detector::kGfttOrb;
  int max_features = 500;
  // GFTT
  double quality = 0.001, min_distance_px = 7, harris_k = 0.04;
  int block_px = 3;
  bool harris = false;
  // ORB
  double scale_factor = 2;
  int levels = 3, edge_px = 19, first_level = 0, wta_k = 2, patch_px = 31, fast_threshold = 20;
  bool fast_score = false;
  // SIFT
  int octave_layers = 3;
  double contrast = 0.04, edge_ratio = 10, sigma = 1.6;
  // BRISK
  int brisk_threshold = 30, brisk_octaves = 3;
  double brisk_scale = 1;

  // Of the descriptor: bytes, and whether it is compared bit by bit.
  std::uint32_t descriptor_bytes() const noexcept;
  bool binary() const noexcept { return detector != Detector::kSift; }
};

// From a manifest's provenance.detector: RTAB-Map's number of the detector, and after a blank its
// settings, "Key:value;Key:value". Without settings RTAB-Map's defaults hold. Fails for a detector
// that this program lacks, by its name; `map` stands in the message.
Outcome<DetectorSettings> parse_detector(std::string_view provenance, const std::string& map);

}  // namespace zonepack::localize
