// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/foreign_map.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

namespace zonepack::packer {
namespace {

namespace fs = std::filesystem;
using std::string_view_literals::operator""sv;

std::string beginning_of(const fs::path& file) {
  std::string bytes(4096, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

// Page 0 of an LMDB environment is a meta page: after 16 bytes of page header its magic number.
bool is_lmdb(std::string_view bytes) {
  return bytes.size() > 20 && bytes.substr(16, 4) == "\xDE\xC0\xEF\xBE"sv;
}

// A file that holds one line, which is a path: a symbolic link that a checkout turned into text.
std::string path_in(std::string_view bytes) {
  while (!bytes.empty() && (bytes.back() == '\n' || bytes.back() == '\r')) bytes.remove_suffix(1);
  const bool text = !bytes.empty() && bytes.size() < 1024 &&
                    std::ranges::all_of(bytes, [](unsigned char c) { return c >= 32 && c != 127; });
  const bool path = text && (bytes.find('/') != bytes.npos || bytes.ends_with(".db") ||
                             bytes.ends_with(".msg") || bytes.ends_with(".pcd"));
  return path ? std::string(bytes) : std::string();
}

}  // namespace

std::string foreign_map(const fs::path& path) {
  std::error_code error;
  const bool folder = fs::is_directory(path, error);
  const std::string bytes = beginning_of(folder ? path / "data.mdb" : path);
  if (is_lmdb(bytes)) {
    return "an LMDB environment, as cuVSLAM saves its maps; its content is not documented. Pack "
           "the map of the same drive that nvblox (.nvblx) or RTAB-Map (.db) saved";
  }
  if (folder) return {};
  if (bytes.starts_with("\xDB\x01\xF5\x5B\x7B\x1F\x1D\x7B"sv)) {
    return "a Cartographer state (.pbstream), which holds laser submaps of a format of its own; "
           "write its points with cartographer_assets_writer (pcd_writer) and pack the .pcd";
  }
  const bool boost = bytes.substr(0, 64).find("serialization::archive") != bytes.npos;
  const bool slam_toolbox = path.extension() == ".posegraph" || bytes.find("karto") != bytes.npos;
  if (boost && slam_toolbox) {
    return "a pose graph of slam_toolbox (.posegraph), which holds laser scans in a format of its "
           "own; save its occupancy grid with map_saver_cli, or map with RTAB-Map";
  }
  if (boost) {
    return "a Boost archive, as ORB-SLAM3 saves its atlas (.osa), which only the same build of the "
           "program can read; map with stella_vslam (.msg, .db) or RTAB-Map (.db)";
  }
  if (const std::string target = path_in(bytes); !target.empty()) {
    return "a text file with the path '" + target +
           "': a symbolic link that was copied as text. Give that file itself";
  }
  return {};
}

}  // namespace zonepack::packer
