// SPDX-License-Identifier: Apache-2.0
#include "packer/console/output_path.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "platform/base/shell_word.hpp"

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_output(const std::string& path, const std::string& text) {
  throw std::runtime_error(path + ": cannot be written: " + text);
}

bool takes_files(const fs::path& folder) { return ::access(folder.c_str(), W_OK | X_OK) == 0; }

}  // namespace

fs::path folder_around(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

void require_writable(const std::string& file) {
  if (file.empty() || file == "-") return;
  std::error_code ignored;
  const fs::file_status there = fs::status(file, ignored);
  if (fs::is_directory(there)) {
    refuse_output(file, "a folder of that name exists; give the name of a file");
  }
  // A device or a pipe is written in place.
  if (fs::exists(there) && !fs::is_regular_file(there)) return;
  const fs::path folder = folder_around(file);
  const fs::file_status status = fs::status(folder, ignored);
  if (!fs::exists(status)) {
    refuse_output(file, "there is no folder " + folder.string() + "; create it first: mkdir -p " +
                            shell_word(folder.string()));
  }
  if (!fs::is_directory(status)) {
    refuse_output(file, folder.string() + " is no folder; give another path");
  }
  if (!takes_files(folder)) {
    refuse_output(file, "its folder " + folder.string() +
                            " takes no new files: " + std::strerror(errno) + "; give another path");
  }
}

void require_writable_folder(const fs::path& folder, const std::string& option) {
  std::error_code ignored;
  fs::path there = folder;
  // "map/" is the folder "map".
  if (!there.has_filename() && there.has_parent_path()) there = there.parent_path();
  while (!fs::exists(fs::status(there, ignored))) {
    const fs::path parent = folder_around(there);
    if (parent == there) break;
    there = parent;
  }
  const std::string instead = "; give another " + option;
  if (!fs::is_directory(there, ignored)) {
    throw std::runtime_error(
        folder.string() + ": cannot create the folder: " +
        (there == folder ? "a file of that name exists" : there.string() + " is no folder") +
        instead);
  }
  if (!takes_files(there)) {
    throw std::runtime_error(folder.string() + ": cannot be written: " + there.string() +
                             " takes no new files: " + std::strerror(errno) + instead);
  }
}

}  // namespace zonepack::packer
