// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/voxel_encoder.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>

#include "packer/encode/bit_writer.hpp"
#include "packer/encode/voxel_form.hpp"
#include "packer/record/append_value.hpp"
#include "platform/base/require.hpp"
#include "runtime/pack_format/column.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

using Plane = VoxelPlane::Values;

// A plane in one of the ways that it can be written.
struct Draft {
  VoxelSpread spread = VoxelSpread::kEach;
  VoxelChoice choice = VoxelChoice::kNone;
  std::array<std::uint32_t, 3> constants{};
  ListForm form;
  std::size_t bytes = std::numeric_limits<std::size_t>::max();
};

// What the next plane may refer to: the runs and the choice of the plane before.
struct Before {
  std::optional<std::array<bool, kVoxelsOfBlock>> starts;  // where it has runs
  VoxelChoice choice = VoxelChoice::kNone;
  std::size_t runs = 0;
  std::array<std::uint8_t, kVoxelsOfBlock> codes{};  // of each run
};

constexpr std::size_t constants_of(VoxelChoice choice) {
  return choice == VoxelChoice::kOneOfTwo ? 1 : choice == VoxelChoice::kOneOfFour ? 3 : 0;
}

class PlaneEncoder {
 public:
  PlaneEncoder(const Plane& plane, Before& before, Bytes& out)
      : plane_(plane), before_(before), out_(out) {}

  void encode() {
    if (std::ranges::all_of(plane_, [this](auto v) { return v == plane_[0]; })) {
      VoxelList one;
      one.push(plane_[0]);
      try_list(VoxelSpread::kEach, one, kVoxelsOfBlock);
    } else {
      try_spreads();
    }
    write();
  }

 private:
  void try_spreads() {
    VoxelList each{plane_, kVoxelsOfBlock};
    VoxelList columns, runs;
    bool by_columns = true;
    for (std::size_t i = 0; i < kVoxelsOfBlock; ++i) {
      starts_[i] = i == 0 || plane_[i] != plane_[i - 1];
      if (starts_[i]) runs.push(plane_[i]);
      if (i % kBlockSide == 0) columns.push(plane_[i]);
      by_columns = by_columns && plane_[i] == columns.values[columns.size - 1];
    }
    if (by_columns) try_list(VoxelSpread::kColumns, columns, columns.size);
    if (before_.starts) {
      VoxelList held;
      bool fits = true;
      for (std::size_t i = 0; i < kVoxelsOfBlock && fits; ++i) {
        if ((*before_.starts)[i]) held.push(plane_[i]);
        fits = plane_[i] == held.values[held.size - 1];
      }
      if (fits) try_list(VoxelSpread::kAsBefore, held, held.size);
    }
    if (runs.size < kWorthRuns) try_list(VoxelSpread::kRuns, runs, runs.size);
    try_list(VoxelSpread::kEach, each, kVoxelsOfBlock);
  }

  // The list with each choice; `runs` values in all.
  void try_list(VoxelSpread spread, const VoxelList& list, std::size_t runs) {
    const std::size_t fixed = 2 + (spread == VoxelSpread::kRuns ? kVoxelsOfBlock / 8 : 0);
    const VoxelCensus census(list.all());
    offer(spread, VoxelChoice::kNone, {}, list, census, fixed);
    if (census.size() < 2) return;
    const auto three = census.most_frequent<3>();
    const std::size_t bitmap = (runs + 7) / 8;
    {
      VoxelList others;
      for (const std::uint32_t value : list.all()) {
        if (value != three[0]) others.push(value);
      }
      if (others.size + runs / 16 < list.size) {
        offer(spread, VoxelChoice::kOneOfTwo, three, others, VoxelCensus(others.all()),
              fixed + 4 + bitmap);
      }
    }
    if (census.size() >= 3) {
      VoxelList others;
      for (const std::uint32_t value : list.all()) {
        if (std::ranges::find(three, value) == three.end()) others.push(value);
      }
      if (others.size + runs / 8 < list.size) {
        offer(spread, VoxelChoice::kOneOfFour, three, others, VoxelCensus(others.all()),
              fixed + 12 + 2 * bitmap);
      }
    }
    try_choice_before(spread, list, runs, fixed);
  }

  void try_choice_before(VoxelSpread spread, const VoxelList& list, std::size_t runs,
                         std::size_t fixed) {
    if (before_.choice == VoxelChoice::kNone || before_.runs != runs || list.size != runs) return;
    const std::size_t constants = constants_of(before_.choice);
    std::array<std::optional<std::uint32_t>, 3> found;
    VoxelList others;
    for (std::size_t i = 0; i < runs; ++i) {
      const std::size_t code = before_.codes[i];
      if (code == constants) {
        others.push(list.values[i]);
        continue;
      }
      if (!found[code]) found[code] = list.values[i];
      if (*found[code] != list.values[i]) return;
    }
    std::array<std::uint32_t, 3> values{};
    for (std::size_t i = 0; i < 3; ++i) values[i] = found[i].value_or(0);
    offer(spread, VoxelChoice::kAsBefore, values, others, VoxelCensus(others.all()),
          fixed + 4 * constants);
  }

  void offer(VoxelSpread spread, VoxelChoice choice, const std::array<std::uint32_t, 3>& constants,
             const VoxelList& list, const VoxelCensus& census, std::size_t fixed) {
    const ListForm form = smallest_form(list, census);
    if (fixed + form.bytes >= best_.bytes) return;
    best_ = {spread, choice, constants, form, fixed + form.bytes};
    list_ = list;
  }

  template <typename Test>
  void put_bitmap(std::size_t count, Test&& test) {
    BitWriter writer(out_);
    for (std::size_t i = 0; i < count; ++i) writer.put(test(i) ? 1 : 0, 1);
    writer.finish();
  }

  void write() {
    put_u8(static_cast<std::size_t>(best_.spread) | static_cast<std::size_t>(best_.choice) << 2,
           out_);
    put_u8(static_cast<std::size_t>(best_.form.form), out_);
    std::vector<std::uint32_t> values;  // after the spread
    std::array<bool, kVoxelsOfBlock> begins{};
    for (std::size_t i = 0; i < kVoxelsOfBlock; ++i) {
      begins[i] = best_.spread == VoxelSpread::kEach ||
                  (best_.spread == VoxelSpread::kColumns && i % kBlockSide == 0) ||
                  (best_.spread == VoxelSpread::kRuns && starts_[i]) ||
                  (best_.spread == VoxelSpread::kAsBefore && (*before_.starts)[i]);
      if (begins[i]) values.push_back(plane_[i]);
    }
    if (best_.spread == VoxelSpread::kRuns) {
      put_bitmap(kVoxelsOfBlock, [&](std::size_t i) { return starts_[i]; });
    }
    write_choice(values);
    write_form(best_.form, list_, out_);
    remember(begins, values);
  }

  void write_choice(const std::vector<std::uint32_t>& values) {
    const bool as_before = best_.choice == VoxelChoice::kAsBefore;
    choice_ = as_before ? before_.choice : best_.choice;
    const std::size_t constants = constants_of(choice_);
    if (constants == 0) return;
    for (std::size_t i = 0; i < constants; ++i) append_value(out_, best_.constants[i]);
    if (as_before) {
      codes_ = before_.codes;
      return;
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto end = best_.constants.begin() + static_cast<std::ptrdiff_t>(constants);
      codes_[i] = static_cast<std::uint8_t>(std::find(best_.constants.begin(), end, values[i]) -
                                            best_.constants.begin());
    }
    put_bitmap(values.size(), [&](std::size_t i) { return (codes_[i] & 1) != 0; });
    if (constants == 3) {
      put_bitmap(values.size(), [&](std::size_t i) { return (codes_[i] & 2) != 0; });
    }
  }

  void remember(const std::array<bool, kVoxelsOfBlock>& begins,
                const std::vector<std::uint32_t>& values) {
    const bool runs = best_.spread == VoxelSpread::kRuns || best_.spread == VoxelSpread::kAsBefore;
    before_.starts.reset();
    if (runs) before_.starts = begins;
    before_.choice = choice_;
    before_.runs = values.size();
    before_.codes = codes_;
  }

  // A bitmap of runs takes 64 bytes, what 16 values of 32 bits do.
  static constexpr std::size_t kWorthRuns = kVoxelsOfBlock - 16;

  const Plane& plane_;
  Before& before_;
  Bytes& out_;
  std::array<bool, kVoxelsOfBlock> starts_{};
  Draft best_;
  VoxelList list_;  // of best_
  VoxelChoice choice_ = VoxelChoice::kNone;
  std::array<std::uint8_t, kVoxelsOfBlock> codes_{};
};

}  // namespace

void encode_block(std::span<const std::byte> blob, std::uint32_t planes, Bytes& out) {
  ZP_REQUIRE(blob.size() == bytes_of_block(planes));
  const std::size_t begin = out.size();
  Before before;
  Plane plane;
  for (std::uint32_t p = 0; p < planes; ++p) {
    for (std::size_t i = 0; i < kVoxelsOfBlock; ++i) {
      std::memcpy(&plane[i], blob.data() + (i * planes + p) * 4, 4);
    }
    PlaneEncoder(plane, before, out).encode();
  }
  const std::size_t end = out.size();
  out.resize(end + kColumnPadding);
  std::array<std::byte, bytes_of_block(kMostPlanes)> decoded;
  const auto again = std::span(decoded).first(blob.size());
  ZP_REQUIRE(copy_block(ByteSpan(out).subspan(begin, end - begin), planes, again) &&
             std::memcmp(again.data(), blob.data(), blob.size()) == 0);
  out.resize(end);
}

}  // namespace zonepack::packer
