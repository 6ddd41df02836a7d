// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/input_writer.hpp"

#include "platform/base/require.hpp"

namespace zonepack {

InputWriter::InputWriter(InputTap& tap, std::int64_t period_ns, std::size_t zones,
                         RecordingFile* file, FlightRecorder* flight)
    : tap_(tap),
      file_(file),
      flight_(flight),
      mirror_(zones),
      block_(period_ns, tap.most_cycle_bytes()) {}

void InputWriter::drain(std::int64_t now_ns) {
  take_all(now_ns);
  if (now_ns - block_began_ns_ >= kMostWait_ns) end_block();
}

void InputWriter::flush() {
  take_all(block_began_ns_);
  end_block();
}

void InputWriter::take_all(std::int64_t now_ns) {
  TappedCycle cycle;
  while (tap_.next(cycle)) take(cycle, now_ns);
}

void InputWriter::take(const TappedCycle& cycle, std::int64_t now_ns) {
  if (cycle.head.cycle == 0) start_ns_ = cycle.head.now_ns;
  const bool offered = cycle.head.offered_map != 0;
  if (offered || !block_.continues(cycle.head.cycle)) end_block();
  if (block_.empty()) {
    begin_block(cycle);
    block_began_ns_ = now_ns;
  }
  if (offered) write_offered(cycle);
  block_.add(cycle);
  next_cycle_ = cycle.head.cycle + 1;
  if (flight_ != nullptr && !cycle.records.empty()) {
    input_.now_ns = cycle.head.now_ns;
    ZP_REQUIRE(read_records(cycle.records, input_));
    mirror_.on_commands(input_.commands);
    mirror_.on_edges(input_.edges);
  }
  if (block_.full()) end_block();
}

void InputWriter::begin_block(const TappedCycle& cycle) {
  const bool gap = cycle.head.cycle != next_cycle_;
  if (flight_ == nullptr || !(gap || flight_->wants_segment())) return;
  const TappedCycle::Head& head = cycle.head;
  Checkpoint checkpoint;
  checkpoint.cycle = head.cycle;
  checkpoint.now_ns = head.now_ns;
  checkpoint.start_ns = start_ns_;
  checkpoint.has_pose = head.has_pose;
  checkpoint.T_map_base = head.T_map_base;
  checkpoint.sigma_m = head.sigma_m;
  checkpoint.sigma_rad = head.sigma_rad;
  checkpoint.map = head.map;
  checkpoint.zone = head.zone;
  checkpoint.lost = head.lost;
  checkpoint.sought = head.sought;
  mirror_.describe(checkpoint);
  if (habits_) checkpoint.transitions = habits_();
  flight_->begin_segment(checkpoint, gap);
}

void InputWriter::add_map(const RecordedMap& map) {
  std::vector<std::byte> blocks = write_map(map);
  const std::lock_guard lock(mutex_);
  coming_.emplace_back(map.number, std::move(blocks));
}

void InputWriter::write_offered(const TappedCycle& cycle) {
  mirror_.on_offer(cycle.head.offered_map);
  std::vector<std::byte> blocks;
  {
    const std::lock_guard lock(mutex_);
    for (auto& [number, bytes] : coming_) {
      if (number == cycle.head.offered_map) blocks = std::move(bytes);
    }
    coming_.clear();
  }
  if (blocks.empty()) return;
  if (file_ != nullptr) file_->append(blocks);
  if (flight_ != nullptr) flight_->add_map(cycle.head.offered_map, blocks, cycle.head.cycle);
}

void InputWriter::end_block() {
  if (block_.empty()) return;
  seal_block(BlockKind::kCycles, block_.content(), sealed_);
  block_.clear();
  if (file_ != nullptr) file_->append(sealed_);
  if (flight_ != nullptr) flight_->append(sealed_, next_cycle_);
}

RecordingEnd InputWriter::end() const {
  RecordingEnd end;
  end.lost = tap_.lost();
  end.cycles = next_cycle_;
  return end;
}

std::uint64_t InputWriter::lost() const noexcept { return tap_.lost(); }

}  // namespace zonepack
