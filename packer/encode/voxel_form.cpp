// SPDX-License-Identifier: Apache-2.0
#include "packer/encode/voxel_form.hpp"

#include <bit>
#include <cmath>
#include <vector>

#include "packer/encode/bit_writer.hpp"
#include "packer/record/append_value.hpp"
#include "runtime/pack_format/column.hpp"

namespace zonepack::packer {
namespace {

constexpr std::uint32_t kMantissaBits = 23;
constexpr std::size_t kMostNames = 256;  // values of a dictionary

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

void offer_packed(std::span<const std::uint32_t> values, ListForm& best) {
  for (const VoxelOrder order : {VoxelOrder::kUnsigned, VoxelOrder::kInt, VoxelOrder::kFloat}) {
    std::uint32_t least = 0xFFFFFFFFu, most = 0;
    for (const std::uint32_t bits : values) {
      const std::uint32_t o = in_order(order, bits);
      least = std::min(least, o);
      most = std::max(most, o);
    }
    ListForm form{.form = VoxelForm::kPacked, .order = order, .base = least};
    form.bits = static_cast<unsigned>(std::bit_width(most - least));
    form.bytes = 6 + bytes_for(values.size(), form.bits);
    best.offer(form);
  }
}

// Values that are all k / 2^fraction, for |k| < 2^24.
void offer_scaled(std::span<const std::uint32_t> values, ListForm& best) {
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
  ListForm form{.form = VoxelForm::kScaled, .base = static_cast<std::uint32_t>(least)};
  form.fraction = fraction;
  form.bits = static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(most - least)));
  form.bytes = 6 + bytes_for(values.size(), form.bits);
  best.offer(form);
}

void offer_float(std::span<const std::uint32_t> values, ListForm& best) {
  ListForm form{.form = VoxelForm::kFloat};
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

void offer_bytes(std::span<const std::uint32_t> values, ListForm& best) {
  ListForm form{.form = VoxelForm::kBytes};
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

std::uint32_t bits_of(const ListForm& form, std::uint32_t value) {
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
void write_values(const VoxelList& list, unsigned bits, Bytes& out, BitsOf&& bits_of_value) {
  BitWriter writer(out);
  for (const std::uint32_t value : list.all()) {
    writer.put(bits_of_value(value), bits);
  }
  writer.finish();
}

}  // namespace

ListForm smallest_form(const VoxelList& list, const VoxelCensus& census) {
  if (census.size() <= 1) {
    ListForm form{.form = VoxelForm::kConstant, .base = list.size == 0 ? 0 : list.values[0]};
    form.bits = 0;
    form.bytes = 4;
    return form;
  }
  ListForm best;
  best.bytes = 4 * list.size;
  if (census.size() <= kMostNames) {
    ListForm form{.form = VoxelForm::kDictionary};
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

void write_form(const ListForm& form, const VoxelList& list, Bytes& out) {
  switch (form.form) {
    case VoxelForm::kConstant:
      append_value(out, form.base);
      return;
    case VoxelForm::kRaw:
      break;
    case VoxelForm::kPacked:
      put_u8(static_cast<std::size_t>(form.order), out);
      put_u8(form.bits, out);
      append_value(out, form.base);
      break;
    case VoxelForm::kScaled:
      put_u8(form.fraction, out);
      put_u8(form.bits, out);
      append_value(out, form.base);
      break;
    case VoxelForm::kDictionary: {
      VoxelCensus census(list.all());
      std::vector<std::uint32_t> names;
      for (std::size_t i = 0; i < census.size(); ++i) names.push_back(census.name(i));
      std::ranges::sort(names);
      put_u8(names.size() - 1, out);
      for (const std::uint32_t name : names) append_value(out, name);
      write_values(list, form.bits, out, [&names](std::uint32_t value) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(names, value) - names.begin());
      });
      return;
    }
    case VoxelForm::kFloat:
      put_u8(form.head_count - 1, out);
      put_u8(form.low_zeros, out);
      for (std::size_t i = 0; i < form.head_count; ++i) {
        put_u8(form.heads[i] & 0xFF, out);
        put_u8(form.heads[i] >> 8, out);
      }
      break;
    case VoxelForm::kBytes:
      for (std::size_t i = 0; i < 4; ++i) {
        put_u8(form.byte_base[i], out);
        put_u8(form.byte_bits[i], out);
      }
      break;
  }
  write_values(list, form.bits, out, [&form](std::uint32_t value) { return bits_of(form, value); });
}

void put_u8(std::size_t value, Bytes& out) { out.push_back(static_cast<std::byte>(value)); }

}  // namespace zonepack::packer
