// SPDX-License-Identifier: Apache-2.0
#include "packer/sources/sqlite/cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "platform/base/number_text.hpp"
#include "platform/base/utf8.hpp"

namespace zonepack::packer {
namespace {

const char* storage_class(int type) {
  switch (type) {
    case SQLITE_INTEGER:
      return "an integer";
    case SQLITE_FLOAT:
      return "a real number";
    case SQLITE_TEXT:
      return "text";
    case SQLITE_BLOB:
      return "a blob";
    default:
      return "NULL";
  }
}

}  // namespace

std::int32_t int32_cell(const SqliteQuery& row, int column, const CellPlace& place) {
  const int type = row.type(column);
  if (type != SQLITE_INTEGER) {
    place.damaged(std::string("expected an integer, found ") + storage_class(type));
  }
  const std::int64_t value = row.integer(column);
  if (value < std::numeric_limits<std::int32_t>::min() ||
      value > std::numeric_limits<std::int32_t>::max()) {
    place.damaged("expected an integer of 32 bits, found " + std::to_string(value));
  }
  return static_cast<std::int32_t>(value);
}

std::int32_t int32_cell(const SqliteQuery& row, int column, const CellPlace& place,
                        std::int32_t if_null) {
  return row.is_null(column) ? if_null : int32_cell(row, column, place);
}

float float_cell(const SqliteQuery& row, int column, const CellPlace& place) {
  const int type = row.type(column);
  if (type != SQLITE_FLOAT && type != SQLITE_INTEGER) {
    place.damaged(std::string("expected a number, found ") + storage_class(type));
  }
  const double value = row.real(column);
  if (std::fabs(value) > std::numeric_limits<float>::max() && !std::isinf(value)) {
    place.damaged("expected a number that a float32 can hold, found " + shortest_number(value));
  }
  return static_cast<float>(value);
}

float float_cell(const SqliteQuery& row, int column, const CellPlace& place, float if_null) {
  return row.is_null(column) ? if_null : float_cell(row, column, place);
}

double finite_cell(const SqliteQuery& row, int column, const CellPlace& place) {
  const int type = row.type(column);
  if (type == SQLITE_NULL) return 0.0;
  if (type != SQLITE_FLOAT && type != SQLITE_INTEGER) {
    place.damaged(std::string("expected a number, found ") + storage_class(type));
  }
  const double value = row.real(column);
  if (!std::isfinite(value))
    place.damaged("expected a finite number, found " + shortest_number(value));
  return value;
}

std::span<const std::byte> blob_cell(const SqliteQuery& row, int column, const CellPlace& place) {
  const int type = row.type(column);
  if (type == SQLITE_NULL) return {};
  if (type != SQLITE_BLOB) {
    place.damaged(std::string("expected a blob, found ") + storage_class(type));
  }
  const auto bytes = row.blob(column);
  const bool nothing =
      bytes.size() <= 4 &&
      std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
  return nothing ? std::span<const std::byte>() : bytes;
}

std::string text_cell(const SqliteQuery& row, int column, const CellPlace& place) {
  const int type = row.type(column);
  if (type == SQLITE_NULL) return {};
  if (type != SQLITE_TEXT) {
    place.damaged(std::string("expected text, found ") + storage_class(type));
  }
  std::string text(row.text(column));
  if (!is_utf8(text)) place.damaged("expected text in UTF-8");
  return text;
}

std::optional<Transform> transform_cell(const SqliteQuery& row, int column,
                                        const CellPlace& place) {
  return transform_from(blob_cell(row, column, place), place);
}

std::optional<Transform> transform_from(std::span<const std::byte> bytes, const CellPlace& place) {
  expect_elements(bytes, 12, sizeof(float), "float32", place);
  if (bytes.empty()) return std::nullopt;
  Transform transform;
  std::memcpy(transform.data(), bytes.data(), sizeof(transform));
  if (!std::all_of(transform.begin(), transform.end(), [](float v) { return std::isfinite(v); })) {
    place.damaged("expected a pose of 12 finite numbers, found NaN or infinity");
  }
  if (std::all_of(transform.begin(), transform.end(), [](float v) { return v == 0.0f; })) {
    return std::nullopt;
  }
  return transform;
}

void expect_elements(std::span<const std::byte> bytes, std::size_t count, std::size_t element,
                     const char* element_name, const CellPlace& place) {
  if (bytes.empty() || bytes.size() == count * element) return;
  place.damaged("expected " + std::to_string(count * element) + " bytes (" + std::to_string(count) +
                " " + element_name + "), found " + std::to_string(bytes.size()));
}

void assign(Bytes& to, std::span<const std::byte> from) { to.assign(from.begin(), from.end()); }

}  // namespace zonepack::packer
