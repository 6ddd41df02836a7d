// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

// Output paths are checked before anything is read, so that a long run does not end in a message
// that could have come first.
namespace zonepack::packer {

// For a file to be written: its folder must exist and take new files, and it must not be a folder
// itself. Does nothing for "" and "-". Throws std::runtime_error that says what to do.
void require_writable(const std::string& file);

// For a folder that is created when missing: it or, when missing, its nearest existing parent must
// be a folder that takes new files.
void require_writable_folder(const std::filesystem::path& folder, const std::string& option);

// The folder that a file stands in: "." for a name alone.
std::filesystem::path folder_around(const std::filesystem::path& file);

}  // namespace zonepack::packer
