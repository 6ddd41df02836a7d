// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/cycle_block.hpp"

#include "platform/base/require.hpp"

namespace zonepack {
namespace {

constexpr std::uint8_t kOtherTime = 1, kOtherOffset = 2, kHasRecords = 4;
constexpr std::size_t kHeadRoom = 64;  // of a block and of a cycle

}  // namespace

CycleBlockWriter::CycleBlockWriter(std::int64_t period_ns, std::size_t most_cycle_bytes)
    : period_ns_(period_ns), buffer_(kGoodBytes + most_cycle_bytes + 2 * kHeadRoom), out_(buffer_) {
  static_assert(kGoodBytes + kMostCycleBytes + 2 * kHeadRoom <= kMostBlockBytes);
}

void CycleBlockWriter::add(const TappedCycle& cycle) {
  const TappedCycle::Head& head = cycle.head;
  ZP_REQUIRE(!full() && continues(head.cycle));
  if (empty()) {
    now_ns_ = wrapped_sub(head.now_ns, period_ns_);
    clock_offset_ns_ = head.clock_offset_ns;
    out_.u64(head.cycle);
    out_.i64(head.now_ns);
    out_.i64(head.clock_offset_ns);
    out_.i64(period_ns_);
  }
  const std::int64_t late_ns = wrapped_sub(head.now_ns, wrapped_add(now_ns_, period_ns_));
  const std::int64_t offset_change_ns = wrapped_sub(head.clock_offset_ns, clock_offset_ns_);
  out_.u8(static_cast<std::uint8_t>((late_ns != 0 ? kOtherTime : 0) |
                                    (offset_change_ns != 0 ? kOtherOffset : 0) |
                                    (!cycle.records.empty() ? kHasRecords : 0)));
  if (late_ns != 0) out_.zigzag(late_ns);
  if (offset_change_ns != 0) out_.zigzag(offset_change_ns);
  if (!cycle.records.empty()) {
    out_.varint(cycle.records.size());
    out_.bytes(cycle.records);
  }
  ZP_REQUIRE(out_.ok());
  next_cycle_ = head.cycle + 1;
  now_ns_ = head.now_ns;
  clock_offset_ns_ = head.clock_offset_ns;
}

void CycleBlockWriter::clear() noexcept { out_ = ByteWriter(buffer_); }

CycleBlockReader::CycleBlockReader(ByteSpan content) noexcept : in_(content) {
  if (content.empty()) return;
  next_cycle_ = in_.u64();
  const std::int64_t first_ns = in_.i64();
  clock_offset_ns_ = in_.i64();
  period_ns_ = in_.i64();
  now_ns_ = wrapped_sub(first_ns, period_ns_);
}

Result<void> CycleBlockReader::next(RecordedInput& into) {
  const std::uint8_t bits = in_.u8();
  if (bits >= 2 * kHasRecords) return ErrorCode::kBadStructure;
  now_ns_ = wrapped_add(now_ns_, period_ns_);
  if ((bits & kOtherTime) != 0) now_ns_ = wrapped_add(now_ns_, in_.zigzag());
  if ((bits & kOtherOffset) != 0) clock_offset_ns_ = wrapped_add(clock_offset_ns_, in_.zigzag());
  const ByteSpan records = (bits & kHasRecords) != 0 ? in_.bytes(in_.varint()) : ByteSpan();
  if (!in_.ok()) return ErrorCode::kBadStructure;
  ++next_cycle_;
  into.now_ns = now_ns_;
  return read_records(records, into);
}

}  // namespace zonepack
