// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/cloud/point_stream.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace zonepack::packer {

File open_file(const std::string& path) {
  File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw std::runtime_error(path + ": cannot be read: " + std::strerror(errno));
  return file;
}

}  // namespace zonepack::packer
