// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/flight_names.hpp"

#include <algorithm>
#include <filesystem>

namespace zonepack {
namespace {

constexpr const char* kSegment = "segment-";
constexpr const char* kMap = "map-";  // sorts before segments
constexpr std::size_t kDigits = 10;

std::string digits_of(std::uint64_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < kDigits) digits.insert(0, kDigits - digits.size(), '0');
  return digits;
}

}  // namespace

std::string flight_segment_name(std::uint64_t number) { return kSegment + digits_of(number); }

std::string flight_map_name(std::uint32_t number) { return kMap + digits_of(number); }

std::vector<std::string> flight_files(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.starts_with(kSegment) || name.starts_with(kMap)) {
      files.push_back(entry->path().string());
    }
  }
  std::ranges::sort(files);
  files.insert(files.begin(), folder + "/" + kFlightPreface);
  return files;
}

}  // namespace zonepack
