// SPDX-License-Identifier: Apache-2.0
#include "tests/system/round_trip/expected_signature.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace zonepack::round_trip {
namespace {

using nlohmann::json;

std::string blob(sqlite3_stmt* row, int column) {
  const void* const data = sqlite3_column_blob(row, column);
  const int size = sqlite3_column_bytes(row, column);
  return data == nullptr
             ? std::string()
             : std::string(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

template <typename T>
std::vector<T> values(const std::string& bytes) {
  std::vector<T> out(bytes.size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

json base64(const std::string& bytes) {
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : bytes) {
    bits = bits << 8 | static_cast<unsigned char>(c);
    for (held += 8; held >= 6; held -= 6) text += digits[bits >> (held - 6) & 63];
  }
  if (held > 0) text += digits[bits << (6 - held) & 63];
  while (text.size() % 4 != 0) text += '=';
  return text;
}

json bytes_or_null(const std::string& bytes) { return bytes.empty() ? json() : base64(bytes); }

json number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

template <typename T>
json numbers(const std::vector<T>& list) {
  json out = json::array();
  for (const T value : list) out.push_back(number(static_cast<double>(value)));
  return out;
}

json transform(const std::vector<float>& m) {
  const bool none = std::all_of(m.begin(), m.end(), [](float v) { return v == 0; });
  return none ? json() : numbers(m);
}

json real_or_null(sqlite3_stmt* row, int column) {
  if (sqlite3_column_type(row, column) == SQLITE_NULL) return {};
  return number(sqlite3_column_double(row, column));
}

// A zlib stream followed by rows, columns and type as three int32.
json unzipped(const std::string& stored) {
  if (stored.empty()) return {};
  const auto shape = values<std::int32_t>(stored.substr(stored.size() - 12));
  static constexpr std::size_t kElement[] = {1, 1, 2, 2, 4, 4, 8};
  const std::size_t size = static_cast<std::size_t>(shape[0]) * static_cast<std::size_t>(shape[1]) *
                           static_cast<std::size_t>((shape[2] >> 3) + 1) *
                           kElement[static_cast<std::size_t>(shape[2] & 7)];
  std::string out(size, '\0');
  uLongf written = size;
  const int code = uncompress(reinterpret_cast<Bytef*>(out.data()), &written,
                              reinterpret_cast<const Bytef*>(stored.data()), stored.size());
  if (code != Z_OK || written != size) throw std::runtime_error("a blob does not unzip");
  return base64(out);
}

std::string inflated(const std::string& stored) {
  z_stream stream{};
  inflateInit(&stream);
  std::string out;
  char piece[65536];
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stored.data()));
  stream.avail_in = static_cast<uInt>(stored.size());
  int code = Z_OK;
  while (code == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece);
    stream.avail_out = sizeof piece;
    code = inflate(&stream, Z_NO_FLUSH);
    out.append(piece, sizeof piece - stream.avail_out);
  }
  inflateEnd(&stream);
  if (code != Z_STREAM_END) throw std::runtime_error("optimised poses do not unzip");
  return out;
}

bool has(const std::vector<std::string>& payload, const char* kind) {
  return std::find(payload.begin(), payload.end(), kind) != payload.end();
}

}  // namespace

template <typename Fn>
void ExpectedSignatures::for_each_row(const std::string& sql, std::int64_t id, Fn&& fn) const {
  sqlite3_stmt* row = nullptr;
  if (sqlite3_prepare_v2(database_, sql.c_str(), -1, &row, nullptr) != SQLITE_OK) {
    throw std::runtime_error(sql + ": " + sqlite3_errmsg(database_));
  }
  sqlite3_bind_int64(row, 1, id);
  while (sqlite3_step(row) == SQLITE_ROW) fn(row);
  sqlite3_finalize(row);
}

ExpectedSignatures::ExpectedSignatures(const std::string& database) {
  const std::string uri = "file:" + database + "?immutable=1";
  if (sqlite3_open_v2(uri.c_str(), &database_, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr) !=
      SQLITE_OK) {
    throw std::runtime_error(database + ": cannot be opened");
  }
  for_each_row("SELECT id FROM Node WHERE weight > -9 ORDER BY id", 0,
               [&](Row row) { ids_.push_back(sqlite3_column_int64(row, 0)); });
  for_each_row("SELECT opt_ids, opt_poses FROM Admin", 0, [&](Row row) {
    const auto ids = values<std::int32_t>(inflated(blob(row, 0)));
    const auto poses = values<float>(inflated(blob(row, 1)));
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const auto first = poses.begin() + static_cast<std::ptrdiff_t>(12 * i);
      optimised_[ids[i]] = transform({first, first + 12});
    }
  });
}

json ExpectedSignatures::features(std::int64_t id) const {
  json out{{"keypoints", json::array()}, {"points", json::array()},   {"word_ids", json::array()},
           {"descriptor_type", nullptr}, {"descriptor_dim", nullptr}, {"descriptors", nullptr}};
  std::string descriptors;
  for_each_row(
      "SELECT pos_x, pos_y, size, dir, response, octave, depth_x, depth_y, depth_z, word_id, "
      "descriptor_size, descriptor FROM Feature WHERE node_id = ?1 ORDER BY rowid",
      id, [&](Row row) {
        json keypoint = json::array();
        for (int i = 0; i < 5; ++i) keypoint.push_back(number(sqlite3_column_double(row, i)));
        keypoint.push_back(sqlite3_column_int64(row, 5));
        out["keypoints"].push_back(keypoint);
        json point = json::array();
        for (int i = 6; i < 9; ++i) point.push_back(real_or_null(row, i));
        const bool none = point[0].is_null() && point[1].is_null() && point[2].is_null();
        out["points"].push_back(none ? json() : point);
        out["word_ids"].push_back(sqlite3_column_int64(row, 9));
        const std::string descriptor = blob(row, 11);
        if (descriptor.empty()) return;
        const std::int64_t dim = sqlite3_column_int64(row, 10);
        out["descriptor_dim"] = dim;
        out["descriptor_type"] = descriptor.size() == static_cast<std::size_t>(dim) ? "u8" : "f32";
        descriptors += descriptor;
      });
  if (!descriptors.empty()) out["descriptors"] = base64(descriptors);
  return out;
}

json ExpectedSignatures::links(std::int64_t id, bool user_data) const {
  json out = json::array();
  for_each_row(
      "SELECT to_id, type, transform, information_matrix, user_data FROM Link WHERE from_id = ?1 "
      "ORDER BY type, to_id",
      id, [&](Row row) {
        const std::string information = blob(row, 3);
        out.push_back(
            {{"to", sqlite3_column_int64(row, 0)},
             {"type", sqlite3_column_int64(row, 1)},
             {"transform", transform(values<float>(blob(row, 2)))},
             {"information", information.empty() ? json() : numbers(values<double>(information))},
             {"user_data", user_data ? unzipped(blob(row, 4)) : json()}});
      });
  return out;
}

json ExpectedSignatures::global_descriptors(std::int64_t id) const {
  json out = json::array();
  for_each_row("SELECT type, info, data FROM GlobalDescriptor WHERE node_id = ?1 ORDER BY rowid",
               id, [&](Row row) {
                 out.push_back({{"type", sqlite3_column_int64(row, 0)},
                                {"info", unzipped(blob(row, 1))},
                                {"data", unzipped(blob(row, 2))}});
               });
  return out;
}

json ExpectedSignatures::signature(std::int64_t id, const std::vector<std::string>& payload) const {
  json out;
  for_each_row(
      "SELECT map_id, weight, stamp, label, pose, ground_truth_pose, velocity, gps, env_sensors "
      "FROM Node WHERE id = ?1",
      id, [&](Row row) {
        out["id"] = id;
        out["map_id"] = sqlite3_column_int64(row, 0);
        out["weight"] = sqlite3_column_int64(row, 1);
        out["stamp"] = number(sqlite3_column_double(row, 2));
        const std::string label = blob(row, 3);
        out["label"] = label.empty() ? json() : json(label);
        out["odometry_pose"] = transform(values<float>(blob(row, 4)));
        out["ground_truth_pose"] = transform(values<float>(blob(row, 5)));
        out["velocity"] = bytes_or_null(blob(row, 6));
        out["gps"] = bytes_or_null(blob(row, 7));
        out["env_sensors"] = bytes_or_null(blob(row, 8));
      });
  const auto optimised = optimised_.find(id);
  out["pose"] = optimised == optimised_.end() ? json() : optimised->second;
  for (const char* key :
       {"keypoints", "points", "word_ids", "descriptor_type", "descriptor_dim", "descriptors",
        "global_descriptors", "scan", "grid", "image", "depth", "calibration", "user_data"}) {
    out[key] = nullptr;
  }
  if (has(payload, "features")) {
    out.update(features(id));
    out["global_descriptors"] = global_descriptors(id);
  }
  out["links"] = links(id, has(payload, "userdata"));
  for_each_row(
      "SELECT image, depth, calibration, scan, scan_info, ground_cells, obstacle_cells, "
      "empty_cells, "
      "cell_size, view_point_x, view_point_y, view_point_z, user_data FROM Data WHERE id = ?1",
      id, [&](Row row) {
        if (has(payload, "image")) out["image"] = bytes_or_null(blob(row, 0));
        if (has(payload, "depth")) out["depth"] = bytes_or_null(blob(row, 1));
        out["calibration"] = bytes_or_null(blob(row, 2));
        if (has(payload, "scan") && sqlite3_column_bytes(row, 3) > 0) {
          const auto info = values<float>(blob(row, 4));
          out["scan"] = {{"format", static_cast<int>(info.at(0))},
                         {"range_min", number(info.at(1))},
                         {"range_max", number(info.at(2))},
                         {"angle_min", number(info.at(3))},
                         {"angle_max", number(info.at(4))},
                         {"angle_increment", number(info.at(5))},
                         {"max_points", number(info.at(6))},
                         {"local_transform", transform({info.begin() + 7, info.begin() + 19})},
                         {"data", unzipped(blob(row, 3))}};
        }
        json cells{{"ground", unzipped(blob(row, 5))},
                   {"obstacle", unzipped(blob(row, 6))},
                   {"empty", unzipped(blob(row, 7))}};
        if (has(payload, "grid") &&
            cells != json{{"ground", {}}, {"obstacle", {}}, {"empty", {}}}) {
          cells["cell_size"] = number(sqlite3_column_double(row, 8));
          cells["view_point"] = json::array();
          for (int i = 9; i < 12; ++i) {
            cells["view_point"].push_back(number(sqlite3_column_double(row, i)));
          }
          out["grid"] = cells;
        }
        if (has(payload, "userdata")) out["user_data"] = unzipped(blob(row, 12));
      });
  return out;
}

std::string first_difference(const json& expected, const json& found, const std::string& at) {
  const auto differ = [&] {
    return at + ": the database has " + expected.dump().substr(0, 200) + ", export printed " +
           found.dump().substr(0, 200);
  };
  if (expected.is_number() && found.is_number()) {
    const bool same = std::bit_cast<std::uint64_t>(expected.get<double>()) ==
                      std::bit_cast<std::uint64_t>(found.get<double>());
    return same ? std::string() : differ();
  }
  if (expected.type() != found.type()) return differ();
  if (expected.is_array()) {
    if (expected.size() != found.size()) return differ();
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const std::string difference =
          first_difference(expected[i], found[i], at + "/" + std::to_string(i));
      if (!difference.empty()) return difference;
    }
    return {};
  }
  if (expected.is_object()) {
    for (const auto& [key, value] : expected.items()) {
      if (!found.contains(key)) return at + "/" + key + ": export printed no such key";
      const std::string difference = first_difference(value, found[key], at + "/" + key);
      if (!difference.empty()) return difference;
    }
    return {};
  }
  return expected == found ? std::string() : differ();
}

}  // namespace zonepack::round_trip
