// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/flight_names.hpp"

#include <algorithm>
#include <filesystem>

namespace zonepack {
namespace {

constexpr const char* kSegment = "segment-";
constexpr std::size_t kDigits = 10;

}  // namespace

std::string flight_segment_name(std::uint64_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < kDigits) digits.insert(0, kDigits - digits.size(), '0');
  return kSegment + digits;
}

std::vector<std::string> flight_files(const std::string& folder) {
  std::vector<std::string> segments;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().filename().string().starts_with(kSegment)) {
      segments.push_back(entry->path().string());
    }
  }
  std::ranges::sort(segments);
  segments.insert(segments.begin(), folder + "/" + kFlightPreface);
  return segments;
}

}  // namespace zonepack
