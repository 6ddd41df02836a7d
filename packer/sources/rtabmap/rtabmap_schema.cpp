// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/rtabmap/rtabmap_schema.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>

#include "platform/base/shell_word.hpp"

namespace zonepack::packer {
namespace {

constexpr SchemaVersion kOldest{0, 11, 0};
constexpr SchemaVersion kFirstUnknown{0, 24, 0};

constexpr const char* kTables[] = {"Node",          "Data", "Link",  "Feature",
                                   "Map_Node_Word", "Info", "Admin", "GlobalDescriptor"};

// Columns that a database newer than the newest known schema needs to be read without loss.
constexpr std::pair<const char*, const char*> kNeeded[] = {{"Node", "map_id"},
                                                           {"Node", "weight"},
                                                           {"Node", "stamp"},
                                                           {"Node", "pose"},
                                                           {"Node", "label"},
                                                           {"Node", "ground_truth_pose"},
                                                           {"Data", "id"},
                                                           {"Data", "image"},
                                                           {"Data", "depth"},
                                                           {"Data", "calibration"},
                                                           {"Data", "scan"},
                                                           {"Data", "scan_info"},
                                                           {"Data", "ground_cells"},
                                                           {"Data", "obstacle_cells"},
                                                           {"Data", "empty_cells"},
                                                           {"Data", "cell_size"},
                                                           {"Data", "view_point_x"},
                                                           {"Data", "user_data"},
                                                           {"Link", "from_id"},
                                                           {"Link", "to_id"},
                                                           {"Link", "type"},
                                                           {"Link", "transform"},
                                                           {"Link", "user_data"},
                                                           {"Link", "information_matrix"},
                                                           {"Feature", "node_id"},
                                                           {"Feature", "word_id"},
                                                           {"Feature", "pos_x"},
                                                           {"Feature", "pos_y"},
                                                           {"Feature", "size"},
                                                           {"Feature", "dir"},
                                                           {"Feature", "response"},
                                                           {"Feature", "octave"},
                                                           {"Feature", "depth_x"},
                                                           {"Feature", "depth_y"},
                                                           {"Feature", "depth_z"},
                                                           {"Feature", "descriptor_size"},
                                                           {"Feature", "descriptor"},
                                                           {"Admin", "opt_ids"},
                                                           {"Admin", "opt_poses"},
                                                           {"GlobalDescriptor", "data"}};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::optional<SchemaVersion> parse_version(std::string_view text) {
  SchemaVersion version;
  int* const parts[] = {&version.major, &version.minor, &version.patch};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [next, error] = std::from_chars(at, end, *parts[i]);
    if (error != std::errc() || *parts[i] < 0) return std::nullopt;
    at = next;
    if (at == end) return i >= 1 ? std::optional(version) : std::nullopt;
    if (*at++ != '.') return std::nullopt;
  }
  return std::nullopt;
}

SchemaVersion read_version(const SqliteFile& file) {
  SqliteQuery query(file, "SELECT version FROM Admin WHERE version IS NOT NULL");
  const std::string text = query.step() ? std::string(query.text(0)) : std::string();
  const auto version = parse_version(text);
  if (!version) {
    throw SqliteError(file.name() + ": Admin.version is '" + text +
                      "', expected the version of RTAB-Map that wrote it, such as 0.23.8");
  }
  return *version;
}

}  // namespace

std::string SchemaVersion::text() const {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

RtabmapSchema::RtabmapSchema(const SqliteFile& file) {
  for (const char* table : kTables) {
    auto columns = file.columns(table);
    if (!columns.empty()) tables_.emplace(table, std::move(columns));
  }
  if (!has("Node", "id") || !has("Node", "map_id") || !has("Admin", "version")) {
    throw SqliteError(file.name() +
                      ": is not an RTAB-Map database (it needs the tables Node and Admin)");
  }
  version_ = read_version(file);
  if (version_ < kOldest) {
    throw SqliteError(file.name() + ": was written by RTAB-Map " + version_.text() +
                      ", older than 0.11; convert it with a newer RTAB-Map (which is no package of "
                      "Debian 12): rtabmap-reprocess " +
                      shell_quoted(file.name()) + " NEW.db");
  }
  feature_table_ = !has("Feature") && has("Map_Node_Word") ? "Map_Node_Word" : "Feature";
  if (version_ >= kFirstUnknown) {
    require_known_columns(file);
    warnings_.push_back(file.name() + ": was written by RTAB-Map " + version_.text() +
                        ", newer than 0.23; every column that is known is there and was read");
    return;
  }
  for (const char* table : {"Data", "Link", feature_table_.c_str()}) {
    if (!has(table)) {
      warnings_.push_back(file.name() + ": has no table " + table + "; nothing is read from it");
    }
  }
}

void RtabmapSchema::require_known_columns(const SqliteFile& file) const {
  for (const auto& [table, column] : kNeeded) {
    if (has(table, column)) continue;
    throw SqliteError(file.name() + ": was written by RTAB-Map " + version_.text() +
                      ", newer than 0.23, and has no column " + table + "." + column +
                      " any more; save it with RTAB-Map 0.23 or use a newer zonepack");
  }
}

bool RtabmapSchema::has(const std::string& table, const std::string& column) const {
  const auto found = tables_.find(table);
  if (found == tables_.end()) return false;
  return std::find(found->second.begin(), found->second.end(), lower(column)) !=
         found->second.end();
}

std::string RtabmapSchema::columns(const std::string& table,
                                   std::initializer_list<const char*> names) const {
  std::string list;
  for (const char* name : names) {
    if (!list.empty()) list += ',';
    list += *name != '\0' && has(table, name) ? name : "NULL";
  }
  return list;
}

}  // namespace zonepack::packer
