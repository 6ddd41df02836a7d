// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/recording_end.hpp"

#include "platform/base/require.hpp"

namespace zonepack {

std::vector<std::byte> write_end(const RecordingEnd& end) {
  std::vector<std::byte> bytes(32 + end.event_log_hash.size());
  ByteWriter out(bytes);
  out.u8(end.run_ended);
  out.u64(end.cycles);
  out.u64(end.lost);
  out.varint(end.event_log_hash.size());
  out.bytes(std::as_bytes(std::span(end.event_log_hash)));
  ZP_REQUIRE(out.ok());
  bytes.resize(out.size());
  return bytes;
}

Result<RecordingEnd> read_end(ByteSpan content) {
  RecordingEnd end;
  ByteReader in(content);
  end.run_ended = in.u8() != 0;
  end.cycles = in.u64();
  end.lost = in.u64();
  const ByteSpan hash = in.bytes(in.varint());
  if (!in.finished()) return ErrorCode::kBadStructure;
  end.event_log_hash.assign(reinterpret_cast<const char*>(hash.data()), hash.size());
  return end;
}

}  // namespace zonepack
