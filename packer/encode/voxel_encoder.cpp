// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/voxel_encoder.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "packer/encode/bit_writer.hpp"
#include "platform/base/require.hpp"
#include "runtime/pack_format/column.hpp"
#include "runtime/pack_format/voxel_block.hpp"

namespace zonepack::packer {
namespace {

constexpr std::uint32_t kMantissaBits = 23;
constexpr std::size_t kMostNames = 256;  // values of a dictionary

using Plane = VoxelPlane::Values;

// At most 512 values.
struct List {
  Plane values;
  std::size_t size = 0;
  std::span<const std::uint32_t> all() const { return {values.data(), size}; }
  void push(std::uint32_t value) { values[size++] = value; }
};

std::uint32_t in_order(VoxelOrder order, std::uint32_t bits) {
  switch (order) {
    case VoxelOrder::kInt:
      return ordered_from_int(bits);
    case VoxelOrder::kFloat:
      return ordered_from_float(bits);
    case VoxelOrder::kUnsigned:
      break;
  }
  return bits;
}

std::size_t bytes_for(std::size_t count, unsigned bits) { return (count * bits + 7) / 8; }

// The distinct values of a list and how often each occurs, in order of first occurrence.
class Census {
 public:
  explicit Census(std::span<const std::uint32_t> values) {
    table_.fill(kNone);
    for (const std::uint32_t value : values) ++counts_[place_of(value)];
  }
  std::size_t size() const { return size_; }
  std::uint32_t name(std::size_t i) const { return names_[i]; }
  std::uint32_t count(std::size_t i) const { return counts_[i]; }

  std::size_t place_of(std::uint32_t value) {
    std::size_t at = (value * 0x9E3779B1u) >> 22;
    for (; table_[at] != kNone; at = (at + 1) & (table_.size() - 1)) {
      if (names_[table_[at]] == value) return table_[at];
    }
    table_[at] = static_cast<std::uint16_t>(size_);
    names_[size_] = value;
    counts_[size_] = 0;
    return size_++;
  }

  // The values that occur most, the earlier of equals first.
  template <std::size_t N>
  std::array<std::uint32_t, N> most_frequent() const {
    std::array<std::uint32_t, N> out{};
    std::array<std::uint32_t, N> times{};
    for (std::size_t i = 0; i < size_; ++i) {
      std::uint32_t value = names_[i], count = counts_[i];
      for (std::size_t k = 0; k < N; ++k) {
        if (count <= times[k]) continue;
        std::swap(value, out[k]);
        std::swap(count, times[k]);
      }
    }
    return out;
  }

 private:
  static constexpr std::uint16_t kNone = 0xFFFF;
  std::array<std::uint16_t, 1024> table_;
  std::array<std::uint32_t, kVoxelsOfBlock> names_;
  std::array<std::uint32_t, kVoxelsOfBlock> counts_;
  std::size_t size_ = 0;
};

// A list's smallest form, and what it takes.
struct Form {
  VoxelForm form = VoxelForm::kRaw;
  VoxelOrder order = VoxelOrder::kUnsigned;
  std::uint32_t base = 0;
  unsigned bits = 32, fraction = 0, low_zeros = 0;
  std::array<std::uint16_t, kMostHeads> heads{};
  std::size_t head_count = 0;
  std::array<std::uint8_t, 4> byte_base{}, byte_bits{};
  std::size_t bytes = std::numeric_limits<std::size_t>::max();

  void offer(const Form& other) {
    if (other.bytes < bytes) *this = other;
  }
};

void offer_packed(std::span<const std::uint32_t> values, Form& best) {
  for (const VoxelOrder order : {VoxelOrder::kUnsigned, VoxelOrder::kInt, VoxelOrder::kFloat}) {
    std::uint32_t least = 0xFFFFFFFFu, most = 0;
    for (const std::uint32_t bits : values) {
      const std::uint32_t o = in_order(order, bits);
      least = std::min(least, o);
      most = std::max(most, o);
    }
    Form form{.form = VoxelForm::kPacked, .order = order, .base = least};
    form.bits = static_cast<unsigned>(std::bit_width(most - least));
    form.bytes = 6 + bytes_for(values.size(), form.bits);
    best.offer(form);
  }
}

// Values that are all k / 2^fraction, for |k| < 2^24.
void offer_scaled(std::span<const std::uint32_t> values, Form& best) {
  constexpr unsigned kMostFraction = 8;
  unsigned fraction = 0;
  for (const std::uint32_t bits : values) {
    const auto value = std::bit_cast<float>(bits);
    if (bits == 0x80000000u || !(std::abs(value) < 65536.0F)) return;
    while (std::trunc(value * static_cast<float>(1u << fraction)) !=
           value * static_cast<float>(1u << fraction)) {
      if (++fraction > kMostFraction) return;
    }
  }
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  std::int32_t most = std::numeric_limits<std::int32_t>::min();
  for (const std::uint32_t bits : values) {
    const auto k =
        static_cast<std::int32_t>(std::bit_cast<float>(bits) * static_cast<float>(1u << fraction));
    least = std::min(least, k);
    most = std::max(most, k);
  }
  Form form{.form = VoxelForm::kScaled, .base = static_cast<std::uint32_t>(least)};
  form.fraction = fraction;
  form.bits = static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(most - least)));
  form.bytes = 6 + bytes_for(values.size(), form.bits);
  best.offer(form);
}

void offer_float(std::span<const std::uint32_t> values, Form& best) {
  Form form{.form = VoxelForm::kFloat};
  std::uint32_t mantissas = 0;
  for (const std::uint32_t bits : values) {
    const auto head = static_cast<std::uint16_t>(bits >> kMantissaBits);
    mantissas |= bits & ((1u << kMantissaBits) - 1);
    const auto end = form.heads.begin() + static_cast<std::ptrdiff_t>(form.head_count);
    if (std::find(form.heads.begin(), end, head) != end) continue;
    if (form.head_count == kMostHeads) return;
    form.heads[form.head_count++] = head;
  }
  std::sort(form.heads.begin(), form.heads.begin() + static_cast<std::ptrdiff_t>(form.head_count));
  form.low_zeros =
      mantissas == 0 ? kMantissaBits : static_cast<unsigned>(std::countr_zero(mantissas));
  form.bits =
      static_cast<unsigned>(std::bit_width(form.head_count - 1)) + kMantissaBits - form.low_zeros;
  form.bytes = 2 + 2 * form.head_count + bytes_for(values.size(), form.bits);
  best.offer(form);
}

void offer_bytes(std::span<const std::uint32_t> values, Form& best) {
  Form form{.form = VoxelForm::kBytes};
  form.bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    std::uint32_t least = 255, most = 0;
    for (const std::uint32_t bits : values) {
      const std::uint32_t byte = bits >> (8 * i) & 0xFF;
      least = std::min(least, byte);
      most = std::max(most, byte);
    }
    form.byte_base[i] = static_cast<std::uint8_t>(least);
    form.byte_bits[i] = static_cast<std::uint8_t>(std::bit_width(most - least));
    form.bits += form.byte_bits[i];
  }
  form.bytes = 8 + bytes_for(values.size(), form.bits);
  best.offer(form);
}

Form smallest_form(const List& list, const Census& census) {
  if (census.size() <= 1) {
    Form form{.form = VoxelForm::kConstant, .base = list.size == 0 ? 0 : list.values[0]};
    form.bits = 0;
    form.bytes = 4;
    return form;
  }
  Form best;
  best.bytes = 4 * list.size;
  if (census.size() <= kMostNames) {
    Form form{.form = VoxelForm::kDictionary};
    form.bits = static_cast<unsigned>(std::bit_width(census.size() - 1));
    form.bytes = 1 + 4 * census.size() + bytes_for(list.size, form.bits);
    best.offer(form);
  }
  offer_packed(list.all(), best);
  offer_scaled(list.all(), best);
  offer_float(list.all(), best);
  offer_bytes(list.all(), best);
  return best;
}

// A plane in one of the ways that it can be written.
struct Draft {
  VoxelSpread spread = VoxelSpread::kEach;
  VoxelChoice choice = VoxelChoice::kNone;
  std::array<std::uint32_t, 3> constants{};
  Form form;
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
      List one;
      one.push(plane_[0]);
      try_list(VoxelSpread::kEach, one, kVoxelsOfBlock);
    } else {
      try_spreads();
    }
    write();
  }

 private:
  void try_spreads() {
    List each{plane_, kVoxelsOfBlock};
    List columns, runs;
    bool by_columns = true;
    for (std::size_t i = 0; i < kVoxelsOfBlock; ++i) {
      starts_[i] = i == 0 || plane_[i] != plane_[i - 1];
      if (starts_[i]) runs.push(plane_[i]);
      if (i % kBlockSide == 0) columns.push(plane_[i]);
      by_columns = by_columns && plane_[i] == columns.values[columns.size - 1];
    }
    if (by_columns) try_list(VoxelSpread::kColumns, columns, columns.size);
    if (before_.starts) {
      List held;
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
  void try_list(VoxelSpread spread, const List& list, std::size_t runs) {
    const std::size_t fixed = 2 + (spread == VoxelSpread::kRuns ? kVoxelsOfBlock / 8 : 0);
    const Census census(list.all());
    offer(spread, VoxelChoice::kNone, {}, list, census, fixed);
    if (census.size() < 3) {
      if (census.size() < 2 || list.size < 2) return;
    }
    const auto three = census.most_frequent<3>();
    const std::size_t bitmap = (runs + 7) / 8;
    {
      List others;
      for (const std::uint32_t value : list.all()) {
        if (value != three[0]) others.push(value);
      }
      if (others.size + runs / 16 < list.size) {
        offer(spread, VoxelChoice::kOneOfTwo, three, others, Census(others.all()),
              fixed + 4 + bitmap);
      }
    }
    if (census.size() >= 3) {
      List others;
      for (const std::uint32_t value : list.all()) {
        if (std::ranges::find(three, value) == three.end()) others.push(value);
      }
      if (others.size + runs / 8 < list.size) {
        offer(spread, VoxelChoice::kOneOfFour, three, others, Census(others.all()),
              fixed + 12 + 2 * bitmap);
      }
    }
    try_choice_before(spread, list, runs, fixed);
  }

  void try_choice_before(VoxelSpread spread, const List& list, std::size_t runs,
                         std::size_t fixed) {
    if (before_.choice == VoxelChoice::kNone || before_.runs != runs || list.size != runs) return;
    const std::size_t constants = constants_of(before_.choice);
    std::array<std::optional<std::uint32_t>, 3> found;
    List others;
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
    offer(spread, VoxelChoice::kAsBefore, values, others, Census(others.all()),
          fixed + 4 * constants);
  }

  void offer(VoxelSpread spread, VoxelChoice choice, const std::array<std::uint32_t, 3>& constants,
             const List& list, const Census& census, std::size_t fixed) {
    const Form form = smallest_form(list, census);
    if (fixed + form.bytes >= best_.bytes) return;
    best_ = {spread, choice, constants, form, fixed + form.bytes};
    list_ = list;
  }

  void put(std::uint32_t value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }
  void put8(std::size_t value) { out_.push_back(static_cast<std::byte>(value)); }

  template <typename Test>
  void put_bitmap(std::size_t count, Test&& test) {
    BitWriter writer(out_);
    for (std::size_t i = 0; i < count; ++i) writer.put(test(i) ? 1 : 0, 1);
    writer.finish();
  }

  void write() {
    put8(static_cast<std::size_t>(best_.spread) | static_cast<std::size_t>(best_.choice) << 2);
    put8(static_cast<std::size_t>(best_.form.form));
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
    write_form();
    remember(begins, values);
  }

  void write_choice(const std::vector<std::uint32_t>& values) {
    const bool as_before = best_.choice == VoxelChoice::kAsBefore;
    choice_ = as_before ? before_.choice : best_.choice;
    const std::size_t constants = constants_of(choice_);
    if (constants == 0) return;
    for (std::size_t i = 0; i < constants; ++i) put(best_.constants[i]);
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

  void write_form() {
    const Form& form = best_.form;
    switch (form.form) {
      case VoxelForm::kConstant:
        put(form.base);
        return;
      case VoxelForm::kRaw:
        break;
      case VoxelForm::kPacked:
        put8(static_cast<std::size_t>(form.order));
        put8(form.bits);
        put(form.base);
        break;
      case VoxelForm::kScaled:
        put8(form.fraction);
        put8(form.bits);
        put(form.base);
        break;
      case VoxelForm::kDictionary: {
        Census census(list_.all());
        std::vector<std::uint32_t> names;
        for (std::size_t i = 0; i < census.size(); ++i) names.push_back(census.name(i));
        std::ranges::sort(names);
        put8(names.size() - 1);
        for (const std::uint32_t name : names) put(name);
        write_values([&names](std::uint32_t value) {
          return static_cast<std::uint32_t>(std::ranges::lower_bound(names, value) - names.begin());
        });
        return;
      }
      case VoxelForm::kFloat:
        put8(form.head_count - 1);
        put8(form.low_zeros);
        for (std::size_t i = 0; i < form.head_count; ++i) {
          put8(form.heads[i] & 0xFF);
          put8(form.heads[i] >> 8);
        }
        break;
      case VoxelForm::kBytes:
        for (std::size_t i = 0; i < 4; ++i) {
          put8(form.byte_base[i]);
          put8(form.byte_bits[i]);
        }
        break;
    }
    write_values([&form](std::uint32_t value) { return bits_of(form, value); });
  }

  static std::uint32_t bits_of(const Form& form, std::uint32_t value) {
    switch (form.form) {
      case VoxelForm::kPacked:
        return in_order(form.order, value) - form.base;
      case VoxelForm::kScaled:
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(
                   std::bit_cast<float>(value) * static_cast<float>(1u << form.fraction))) -
               form.base;
      case VoxelForm::kFloat: {
        const auto end = form.heads.begin() + static_cast<std::ptrdiff_t>(form.head_count);
        const auto head = static_cast<std::uint32_t>(
            std::find(form.heads.begin(), end, value >> kMantissaBits) - form.heads.begin());
        const std::uint32_t mantissa = value & ((1u << kMantissaBits) - 1);
        return head << (kMantissaBits - form.low_zeros) | mantissa >> form.low_zeros;
      }
      case VoxelForm::kBytes: {
        std::uint64_t bits = 0;
        unsigned at = 0;
        for (std::size_t i = 0; i < 4; ++i) {
          bits |= std::uint64_t{(value >> (8 * i) & 0xFF) - form.byte_base[i]} << at;
          at += form.byte_bits[i];
        }
        return static_cast<std::uint32_t>(bits);
      }
      default:
        return value;
    }
  }

  template <typename BitsOf>
  void write_values(BitsOf&& bits_of_value) {
    BitWriter writer(out_);
    for (const std::uint32_t value : list_.all()) {
      writer.put(bits_of_value(value), best_.form.bits);
    }
    writer.finish();
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
  List list_;  // of best_
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
