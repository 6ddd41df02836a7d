// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/base/failure.hpp"

namespace zonepack::localize {

struct ListedImage {
  std::int64_t stamp_ns = 0;
  std::string file;
};

// Reads a list of images as TUM's data sets have them (rgb.txt): `stamp file` a line, the file
// relative to the list's folder. Stamps are seconds or whole nanoseconds, and rise. Empty lines,
// lines that begin with # or % and a first line of column names are passed over; CR and a byte
// order mark too. The file is the rest of the line, blanks included; where there is no such file,
// its first word (lists of associated images have more columns). Fails for a list without images,
// and names the files that are missing.
//
// Memory: lists of at most 1,000,000 images.
Outcome<std::vector<ListedImage>> read_image_list(const std::string& file);

// The images of a folder: those of its rgb.txt; without one, its *.jpg, *.jpeg and *.png files
// whose names are stamps ("1718021600.500000.jpg"), in the order of these.
Outcome<std::vector<ListedImage>> list_image_folder(const std::string& folder);

}  // namespace zonepack::localize
