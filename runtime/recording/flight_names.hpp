// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

// The files of a flight recorder's folder. Joined in the order of flight_files() they are a
// recording.
namespace zonepack {

inline constexpr const char* kFlightPreface = "preface";
std::string flight_segment_name(std::uint64_t number);  // "segment-0000000042"
std::string flight_map_name(std::uint32_t number);      // "map-0000000002"

// Paths of the preface, of maps and of segments, oldest first; the preface even if it is missing.
std::vector<std::string> flight_files(const std::string& folder);

}  // namespace zonepack
