// SPDX-License-Identifier: Apache-2.0
#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "runtime/pack_format/chunk_view.hpp"

// check_core_chunk() in one pass: for each table what FlatBuffers' verifier checks, then what its
// fields mean. The verifier, written for any schema, took a quarter of the time for reading and
// decoding a core chunk. It remains the reference: a test holds both to the same verdicts.
namespace zonepack {
namespace {

using Position = std::uint64_t;  // bytes from the start of the chunk, which is 16-aligned

constexpr std::uint64_t kMinBytes = 12;  // an offset, a table without fields, its vtable
constexpr std::uint64_t kMaxTables = 4096;

// A vector or string; first is 0 when there is none.
struct Elements {
  Position first = 0;
  std::uint64_t count = 0;
  explicit operator bool() const noexcept { return first != 0; }
};

// kMinBytes to kSlotBytes bytes.
class Buffer {
 public:
  explicit Buffer(ByteSpan bytes) noexcept : data_(bytes.data()), size_(bytes.size()) {}

  std::uint64_t size() const noexcept { return size_; }

  // As in the verifier: less than the whole buffer.
  bool holds(Position at, std::uint64_t length) const noexcept {
    return length < size_ && at <= size_ - length;
  }

  template <typename T>
  T read(Position at) const noexcept {
    return flatbuffers::ReadScalar<T>(data_ + at);
  }

  template <typename T>
  const T* structs(const Elements& elements) const noexcept {
    return reinterpret_cast<const T*>(data_ + elements.first);
  }

  // The position of the `i`th table of a vector; may be anywhere.
  Position table(const Elements& tables, std::uint64_t i) const noexcept {
    const Position at = tables.first + i * 4;
    return at + read<std::uint32_t>(at);
  }

  // The target of the offset at `field`, which is known to hold one; none when it does not fit.
  Elements elements(Position field, std::uint64_t element_bytes) const noexcept {
    const std::uint64_t offset = read<std::uint32_t>(field);
    const Position at = field + offset;
    if (offset == 0 || at % 4 != 0 || at > size_ - 4) return {};
    const std::uint64_t count = read<std::uint32_t>(at);
    if (count * element_bytes > size_ - 4 - at) return {};
    return {at + 4, count};
  }

 private:
  const std::byte* data_;
  std::uint64_t size_;
};

// A field's form; alignment is that of the number inside. Fields are in the order of the schema.
struct FieldForm {
  std::uint16_t size;
  std::uint16_t alignment;
};
constexpr FieldForm kByte{1, 1}, kWord{4, 4}, kDouble{8, 8}, kOffset{4, 4};
constexpr FieldForm kTransform{sizeof(fb::Transform), alignof(fb::Transform)};

constexpr std::array kCoreForm{kWord, kOffset, kOffset, kOffset};
constexpr std::array kCalibrationForm{kOffset};
constexpr std::array kSignatureForm{kByte,   kWord,   kWord,      kWord,      kWord,
                                    kDouble, kOffset, kTransform, kTransform, kTransform,
                                    kOffset, kOffset, kOffset,    kOffset};

// Tables of one kind. Those of a chunk share few vtables, so the last one is cached.
template <const auto& kForm>
class Tables {
 public:
  explicit Tables(Buffer buffer) noexcept : buffer_(buffer) {}

  // Whether the table at `at` is in the buffer with all its fields, each aligned.
  bool enter(Position at) noexcept {
    at_ = at;
    return (at <= last_ && (at & align_mask_) == align_ && vtable_of(at) == vtable_) || learn(at);
  }

  // Of the table entered last; `name` is the generated VT_….
  bool has(flatbuffers::voffset_t name) const noexcept { return place_[(name - 4u) / 2u] != 0; }
  Position field(flatbuffers::voffset_t name) const noexcept {
    return at_ + place_[(name - 4u) / 2u];
  }

 private:
  Position vtable_of(Position table) const noexcept {
    return table - static_cast<Position>(std::int64_t{buffer_.template read<std::int32_t>(table)});
  }

  // A function of its own, so that the loop over tables keeps its registers.
  [[gnu::noinline]] bool learn(Position table) noexcept {
    align_mask_ = 0;
    align_ = 1;
    if (table % 4 != 0 || !buffer_.holds(table, 4)) return false;
    const Position vtable = vtable_of(table);
    if (vtable % 2 != 0 || !buffer_.holds(vtable, 2)) return false;
    const std::uint64_t size = buffer_.template read<std::uint16_t>(vtable);
    if (size % 2 != 0 || !buffer_.holds(vtable, size)) return false;
    place_ = {};
    std::uint64_t reach = 4;
    std::uint64_t alignment = 4;
    for (std::size_t i = 0; i < kForm.size() && 4 + 2 * i < size; ++i) {
      const std::uint16_t place = buffer_.template read<std::uint16_t>(vtable + 4 + 2 * i);
      if (place == 0) continue;
      const auto [length, own_alignment] = kForm[i];
      if (((table + place) & (own_alignment - 1u)) != 0) return false;
      place_[i] = place;
      alignment = std::max<std::uint64_t>(alignment, own_alignment);
      reach = std::max<std::uint64_t>(reach, place + length);
    }
    if (!buffer_.holds(table, reach)) return false;
    vtable_ = vtable;
    last_ = buffer_.size() - reach;
    align_mask_ = alignment - 1;
    align_ = table & align_mask_;
    return true;
  }

  const Buffer buffer_;
  Position at_ = 0;
  Position vtable_ = 0;
  Position last_ = 0;                    // the greatest position of a table with this vtable
  Position align_mask_ = 0, align_ = 1;  // no vtable is cached, so none fits
  std::array<std::uint16_t, kForm.size()> place_{};
};

bool is_string(Buffer buffer, Position field) noexcept {
  const Elements text = buffer.elements(field, 1);
  const Position end = text.first + text.count;
  return text && buffer.holds(end, 1) && buffer.read<std::uint8_t>(end) == 0;
}

// Collects references beyond the last of `limit` items without a branch; ~0 refers to none.
class References {
 public:
  explicit References(std::uint64_t limit) noexcept : limit_(limit) {}
  void add(std::uint32_t place) noexcept { beyond_ |= limit_ - (place + 1u); }
  bool are_sound() const noexcept { return beyond_ >> 63 == 0; }

 private:
  std::uint64_t limit_;
  std::uint64_t beyond_ = 0;  // top bit: some difference was negative
};

bool calibrations_are_sound(Buffer buffer, const Elements& calibrations) noexcept {
  Tables<kCalibrationForm> calibration(buffer);
  for (std::uint64_t i = 0; i < calibrations.count; ++i) {
    if (!calibration.enter(buffer.table(calibrations, i)) ||
        !calibration.has(fb::Calibration::VT_DATA) ||
        !buffer.elements(calibration.field(fb::Calibration::VT_DATA), 1)) {
      return false;
    }
  }
  return true;
}

// Every signature's table and what it leads to; `continued` counts those that continue another.
bool signatures_are_sound(Buffer buffer, const Elements& signatures, std::uint64_t informations,
                          std::uint64_t calibrations, std::uint64_t& continued) noexcept {
  using fb::Signature;
  Tables<kSignatureForm> signature(buffer);
  References to_informations(informations);
  References to_calibrations(calibrations);
  std::uint32_t has_transform = 0;
  for (std::uint64_t i = 0; i < signatures.count; ++i) {
    if (!signature.enter(buffer.table(signatures, i))) return false;
    if (signature.has(Signature::VT_CONTINUED) && i != 0) {
      continued += buffer.read<std::uint8_t>(signature.field(Signature::VT_CONTINUED)) != 0;
    }
    if (signature.has(Signature::VT_CALIBRATION)) {
      to_calibrations.add(buffer.read<std::uint32_t>(signature.field(Signature::VT_CALIBRATION)));
    }
    if (signature.has(Signature::VT_LABEL) &&
        !is_string(buffer, signature.field(Signature::VT_LABEL))) {
      return false;
    }
    for (const auto name : {Signature::VT_VELOCITY, Signature::VT_GPS, Signature::VT_ENV_SENSORS}) {
      if (signature.has(name) && !buffer.elements(signature.field(name), 1)) return false;
    }
    if (!signature.has(Signature::VT_LINKS)) continue;
    const Elements links = buffer.elements(signature.field(Signature::VT_LINKS), sizeof(fb::Link));
    if (!links) return false;
    const fb::Link* const all = buffer.structs<fb::Link>(links);
    for (std::uint64_t k = 0; k < links.count; ++k) {
      to_informations.add(all[k].information());
      has_transform |= all[k].has_transform();
    }
  }
  return has_transform <= 1 && to_informations.are_sound() && to_calibrations.are_sound();
}

}  // namespace

Result<void> check_core_chunk(ByteSpan bytes, const fb::ChunkEntry& entry) noexcept {
  using fb::CoreChunk;
  if (bytes.size() < kMinBytes || bytes.size() > kSlotBytes) return ErrorCode::kBadStructure;
  const Buffer buffer(bytes);
  Tables<kCoreForm> root(buffer);
  if (!root.enter(buffer.read<std::uint32_t>(0)) || !root.has(CoreChunk::VT_SIGNATURES)) {
    return ErrorCode::kBadStructure;
  }
  const Elements signatures = buffer.elements(root.field(CoreChunk::VT_SIGNATURES), 4);
  if (!signatures) return ErrorCode::kBadStructure;
  Elements informations, calibrations;
  if (root.has(CoreChunk::VT_INFORMATIONS)) {
    informations = buffer.elements(root.field(CoreChunk::VT_INFORMATIONS), sizeof(fb::Information));
    const bool aligned = informations.first % alignof(fb::Information) == 0;
    if (!informations || (informations.count != 0 && !aligned)) return ErrorCode::kBadStructure;
  }
  if (root.has(CoreChunk::VT_CALIBRATIONS)) {
    calibrations = buffer.elements(root.field(CoreChunk::VT_CALIBRATIONS), 4);
    if (!calibrations) return ErrorCode::kBadStructure;
  }
  std::uint64_t continued = 0;
  if (1 + signatures.count + calibrations.count > kMaxTables ||
      !calibrations_are_sound(buffer, calibrations) ||
      !signatures_are_sound(buffer, signatures, informations.count, calibrations.count,
                            continued)) {
    return ErrorCode::kBadStructure;
  }
  std::uint64_t first = 0;
  if (root.has(CoreChunk::VT_FIRST_SIGNATURE)) {
    first = buffer.read<std::uint32_t>(root.field(CoreChunk::VT_FIRST_SIGNATURE));
  }
  if (signatures.count == 0 || first != entry.first_signature() ||
      first + signatures.count - 1 - continued != entry.last_signature()) {
    return ErrorCode::kMismatch;
  }
  return {};
}

}  // namespace zonepack
