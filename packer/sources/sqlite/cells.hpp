// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "packer/record/damage.hpp"
#include "packer/record/record.hpp"
#include "packer/sources/sqlite/sqlite.hpp"

// Typed reading of one value of a row. Each function checks the value's storage class and range and
// throws through `place` (CellPlace::damaged); nothing is rounded, truncated or converted silently.
namespace zonepack::packer {

// Whole numbers that fit 32 bits.
std::int32_t int32_cell(const SqliteQuery& row, int column, const CellPlace& place);
// The same; NULL gives `if_null`.
std::int32_t int32_cell(const SqliteQuery& row, int column, const CellPlace& place,
                        std::int32_t if_null);

// Numbers in the range of float32, rounded to the nearest as RTAB-Map does when it reads them.
float float_cell(const SqliteQuery& row, int column, const CellPlace& place);
float float_cell(const SqliteQuery& row, int column, const CellPlace& place, float if_null);

// Any finite number; NULL gives 0, as RTAB-Map reads it.
double finite_cell(const SqliteQuery& row, int column, const CellPlace& place);

// Bytes; empty for NULL. RTAB-Map also stores "nothing" as up to four zero bytes: empty, too.
std::span<const std::byte> blob_cell(const SqliteQuery& row, int column, const CellPlace& place);

// Text in UTF-8; empty for NULL.
std::string text_cell(const SqliteQuery& row, int column, const CellPlace& place);

// 12 float32. NULL, empty and all zero mean none; NaN and infinity are damage.
std::optional<Transform> transform_cell(const SqliteQuery& row, int column, const CellPlace& place);
std::optional<Transform> transform_from(std::span<const std::byte> bytes, const CellPlace& place);

// Throws unless `bytes` is empty or holds exactly `count` elements of `element` bytes ("float32").
void expect_elements(std::span<const std::byte> bytes, std::size_t count, std::size_t element,
                     const char* element_name, const CellPlace& place);

void assign(Bytes& to, std::span<const std::byte> from);

}  // namespace zonepack::packer
