// SPDX-License-Identifier: Apache-2.0
#include "runtime/state/saved_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "platform/base/require.hpp"
#include "runtime/odometry/se2.hpp"
#include "runtime/pack_format/file/small_file.hpp"
#include "runtime/pack_format/limits.hpp"
#include "runtime/recording/bytes.hpp"

namespace zonepack {
namespace {

constexpr std::uint8_t kMagic[8] = {0x89, 'Z', 'P', 'S', '\r', '\n', 0x1A, '\n'};
constexpr std::uint16_t kMajor = 1, kMinor = 0;

bool is_usable(const SavedState& state) {
  const Covariance2& c = state.covariance;
  return is_finite(state.T_map_base) &&
         std::ranges::all_of(
             std::initializer_list<double>{c.xx, c.xy, c.x_yaw, c.yy, c.y_yaw, c.yaw_yaw},
             [](double value) { return std::isfinite(value); }) &&
         c.xx >= 0 && c.yy >= 0 && c.yaw_yaw >= 0;
}

}  // namespace

std::vector<std::byte> write_state(const SavedState& state) {
  ZP_REQUIRE(state.zone.size() <= kMaxNameBytes);
  std::vector<std::byte> file(kMostStateBytes);
  ByteWriter out(std::span<std::byte>(file).subspan(kSmallFileHeaderBytes));
  out.u64(state.sequence);
  out.u64(state.runs);
  out.bytes(std::as_bytes(std::span(state.map_lineage)));
  out.bytes(std::as_bytes(std::span(state.map_version)));
  out.i64(state.realtime_ns);
  const Covariance2& c = state.covariance;
  for (const double value : {state.T_map_base.x_m, state.T_map_base.y_m, state.T_map_base.yaw_rad,
                             c.xx, c.xy, c.x_yaw, c.yy, c.y_yaw, c.yaw_yaw}) {
    out.f64(value);
  }
  out.u8(state.trusted);
  out.u8(static_cast<std::uint8_t>(state.zone.size()));
  out.bytes(std::as_bytes(std::span(state.zone)));
  complete_small_file(file, kMagic, kMajor, kMinor, out);
  return file;
}

Result<SavedState> read_state(ByteSpan file) {
  ByteReader header(file);
  for (const std::uint8_t byte : kMagic) {
    if (header.u8() != byte) return header.ok() ? ErrorCode::kBadMagic : ErrorCode::kTruncated;
  }
  const std::uint16_t major = header.u16();
  header.u16();
  const std::uint32_t size = header.u32();
  const std::uint64_t checksum = header.u64();
  const ByteSpan content = header.bytes(size);
  if (!header.ok()) return {ErrorCode::kTruncated, static_cast<std::int64_t>(file.size())};
  if (major != kMajor) return {ErrorCode::kBadVersion, major};
  if (xxh3(content) != checksum) return ErrorCode::kBadChecksum;

  SavedState state;
  ByteReader in(content);
  state.sequence = in.u64();
  state.runs = in.u64();
  read_digest(in, state.map_lineage);
  read_digest(in, state.map_version);
  state.realtime_ns = in.i64();
  Covariance2& c = state.covariance;
  for (double* const value :
       {&state.T_map_base.x_m, &state.T_map_base.y_m, &state.T_map_base.yaw_rad, &c.xx, &c.xy,
        &c.x_yaw, &c.yy, &c.y_yaw, &c.yaw_yaw}) {
    *value = in.f64();
  }
  state.trusted = in.u8() != 0;
  const ByteSpan name = in.bytes(in.u8());
  if (!in.ok()) return ErrorCode::kBadStructure;
  state.zone.assign(reinterpret_cast<const char*>(name.data()), name.size());
  if (!is_usable(state)) return ErrorCode::kBadValue;
  return state;
}

}  // namespace zonepack
