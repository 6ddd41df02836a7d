// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/reference_checks.hpp"

#include <bit>
#include <cstring>

#include "runtime/pack_format/chunk_view.hpp"
#include "runtime/pack_format/struct_alignment.hpp"

namespace zonepack::fuzz {
namespace {

flatbuffers::Verifier verifier_for(ByteSpan bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), 4, 4096};
}

bool refers(std::uint32_t place, std::uint32_t count) {
  return place == 0xFFFFFFFFu || place < count;
}

bool accepts_core(ByteSpan bytes, const fb::ChunkEntry& entry) {
  flatbuffers::Verifier verifier = verifier_for(bytes);
  if (!fb::VerifyCoreChunkBuffer(verifier)) return false;
  const fb::CoreChunk& chunk = *fb::GetCoreChunk(bytes.data());
  if (!is_aligned(chunk.informations())) return false;
  const std::uint32_t informations = chunk.informations() ? chunk.informations()->size() : 0;
  const std::uint32_t calibrations = chunk.calibrations() ? chunk.calibrations()->size() : 0;
  std::uint64_t begun = 0;
  for (const fb::Signature* s : *chunk.signatures()) {
    if (begun == 0 || !s->continued()) ++begun;
    if (!refers(s->calibration(), calibrations)) return false;
    if (!is_aligned(s->pose()) || !is_aligned(s->odometry_pose()) ||
        !is_aligned(s->ground_truth_pose()) || !is_aligned(s->links())) {
      return false;
    }
    if (s->links() == nullptr) continue;
    for (const fb::Link* link : *s->links()) {
      if (link->has_transform() > 1 || !refers(link->information(), informations)) return false;
    }
  }
  return begun > 0 && chunk.first_signature() == entry.first_signature() &&
         chunk.first_signature() + (begun - 1) == entry.last_signature();
}

bool codec_fits(const fb::Column& column) {
  using Codec = fb::ColumnCodec;
  const Codec codec = column.codec();
  switch (column.field()) {
    case fb::Field::Shape:
      return codec == Codec::Constant;
    case fb::Field::Info:
      return codec == Codec::Constant || codec == Codec::Raw;
    case fb::Field::Descriptor:
      return codec == Codec::Raw;
    case fb::Field::Voxels:
      return codec == Codec::Planes;
    case fb::Field::Row:
      return codec == Codec::Raw || codec == Codec::Lattice || codec == Codec::Subset;
    default:
      return codec == Codec::Raw ? column.param() == 4 : codec <= Codec::Blocks;
  }
}

bool blocks_fit(ByteSpan bytes, std::uint64_t rows) {
  const std::uint64_t blocks = (rows + kBlockRows - 1) / kBlockRows;
  if (blocks * sizeof(BlockHeader) > bytes.size()) return false;
  std::uint64_t words = 0;
  for (std::uint64_t i = 0; i < blocks; ++i) {
    BlockHeader header;
    std::memcpy(&header, bytes.data() + i * sizeof header, sizeof header);
    if (header.bits > 32 || header.reserved != 0 || header.offset != words) return false;
    words += header.bits;
  }
  return blocks * sizeof(BlockHeader) + words * 4 == bytes.size();
}

bool lattice_fits(ByteSpan bytes, std::uint64_t rows) {
  LatticeHeader header;
  if (bytes.size() < sizeof header) return false;
  std::memcpy(&header, bytes.data(), sizeof header);
  const auto is_near = [](std::int32_t index) { return index > -(1 << 24) && index < 1 << 24; };
  const std::uint64_t cells = std::uint64_t{header.width} * header.height;
  return header.width < 1 << 24 && header.height < 1 << 24 && is_near(header.first_x) &&
         is_near(header.first_y) && cells >= rows &&
         bytes.size() == sizeof header + (cells + 7) / 8;
}

// A plane after the other, each by the table of FORMAT.md, "Planes".
class PlanesReader {
 public:
  explicit PlanesReader(ByteSpan bytes) : bytes_(bytes) {}

  bool plane() {
    const std::size_t how = byte(), form = byte(), spread = how & 3, choice = how >> 2 & 3;
    if (failed_ || how > 15) return false;
    if (spread == 2) {
      const ByteSpan starts = take(64);
      if (failed_ || (std::to_integer<unsigned>(starts[0]) & 1) == 0) return false;
      n_ = ones(starts, {}, 512);
    } else if (spread == 3) {
      if (!had_runs_) return false;
    } else {
      n_ = spread == 0 ? 512 : 64;
    }
    had_runs_ = spread >= 2;
    if (choice == 0) m_ = n_;
    if (choice == 3) {
      if (constants_ == 0 || chosen_of_ != n_) return false;
      take(4 * constants_);
    } else {
      constants_ = choice == 0 ? 0 : choice == 1 ? 1 : 3;
      take(4 * constants_);
      if (choice != 0) {
        const ByteSpan low = take((n_ + 7) / 8);
        const ByteSpan high = choice == 2 ? take((n_ + 7) / 8) : ByteSpan();
        if (failed_) return false;
        m_chosen_ = ones(low, high, n_);
      }
      chosen_of_ = n_;
    }
    if (choice != 0) m_ = m_chosen_;
    const std::size_t width = width_of(form);
    if (failed_ || width > 32) return false;
    take((m_ * width + 7) / 8);
    return !failed_;
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  ByteSpan take(std::size_t count) {
    failed_ = failed_ || bytes_.size() < count;
    if (failed_) return {};
    const ByteSpan taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }
  std::size_t byte() {
    const ByteSpan one = take(1);
    return one.empty() ? 0 : std::to_integer<std::size_t>(one[0]);
  }
  static std::size_t ones(ByteSpan bits, ByteSpan with, std::size_t count) {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto bit = [i](ByteSpan b) { return std::to_integer<unsigned>(b[i / 8]) >> i % 8 & 1; };
      sum += bit(bits) != 0 && (with.empty() || bit(with) != 0);
    }
    return sum;
  }
  static std::size_t bits_of(std::size_t count) {
    return static_cast<std::size_t>(std::bit_width(count - 1));
  }
  // Of a value in the list; over 32 where the form is none.
  std::size_t width_of(std::size_t form) {
    constexpr std::size_t kNone = 99;
    switch (form) {
      case 0:
        take(4);
        return 0;
      case 1:
        return 32;
      case 2:
      case 3: {
        const std::size_t first = byte(), width = byte();
        take(4);
        return form == 2 ? (first <= 2 ? width : kNone)
                         : (first <= 15 && width <= 25 ? width : kNone);
      }
      case 4: {
        const std::size_t count = byte() + 1;
        take(4 * count);
        return bits_of(count);
      }
      case 5: {
        const std::size_t count = byte() + 1, zeros = byte();
        if (count > 64 || zeros > 23) return kNone;
        take(2 * count);
        return 23 - zeros + bits_of(count);
      }
      case 6: {
        std::size_t width = 0;
        for (int i = 0; i < 4; ++i) {
          byte();
          const std::size_t bits = byte();
          width += bits <= 8 ? bits : kNone;
        }
        return width;
      }
      default:
        return kNone;
    }
  }

  ByteSpan bytes_;
  bool failed_ = false, had_runs_ = false;
  std::size_t n_ = 0, m_ = 0, constants_ = 0, chosen_of_ = 0, m_chosen_ = 0;
};

bool planes_fit(ByteSpan bytes, std::uint64_t rows, std::uint32_t planes) {
  if (planes < 1 || planes > 5 || rows * 2 > bytes.size()) return false;
  const ByteSpan blocks = bytes.subspan(static_cast<std::size_t>(rows) * 2);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    std::uint16_t end;
    std::memcpy(&end, bytes.data() + 2 * i, sizeof end);
    if (end < begin || end > blocks.size()) return false;
    PlanesReader reader(blocks.subspan(begin, end - begin));
    for (std::uint32_t p = 0; p < planes; ++p) {
      if (!reader.plane()) return false;
    }
    if (!reader.at_end()) return false;
    begin = end;
  }
  return begin == blocks.size();
}

bool column_fits(const fb::Column& column, ByteSpan bytes, std::uint64_t rows) {
  if (column.field() > fb::Field::MAX || !codec_fits(column)) return false;
  const std::uint64_t end = std::uint64_t{column.offset()} + column.size();
  if (end + kColumnPadding > bytes.size()) return false;
  const ByteSpan own = bytes.subspan(column.offset(), column.size());
  const auto base = static_cast<std::int64_t>(column.base());
  const std::uint64_t packed = (rows * column.bits() + 7) / 8;
  switch (column.codec()) {
    case fb::ColumnCodec::Raw:
      return own.size() == rows * column.param();
    case fb::ColumnCodec::Constant:
      return own.empty();
    case fb::ColumnCodec::Packed:
      return column.bits() <= 32 && own.size() == packed;
    case fb::ColumnCodec::Scaled:
      return column.bits() <= 25 && column.param() <= 15 && base > -(1 << 24) && base < 1 << 24 &&
             own.size() == packed;
    case fb::ColumnCodec::Blocks:
      return blocks_fit(own, rows);
    case fb::ColumnCodec::Lattice:
      return lattice_fits(own, rows);
    case fb::ColumnCodec::Planes:
      return planes_fit(own, rows, column.param());
    case fb::ColumnCodec::Subset:
      return column.base() >> 32 >= rows && own.size() == ((column.base() >> 32) + 7) / 8;
  }
  return false;
}

bool record_fits(const fb::BulkChunk& chunk, const fb::Record& record, ByteSpan bytes,
                 const fb::ChunkEntry& entry) {
  if (record.signature() < entry.first_signature() || record.signature() > entry.last_signature() ||
      record.part() > fb::Part::MAX || kind_of(record.part()) != entry.kind() ||
      record.total_rows() > kMaxRowsPerTable ||
      std::uint64_t{record.first_row()} + record.rows() > record.total_rows() ||
      std::uint64_t{record.first_column()} + record.columns() > chunk.columns()->size()) {
    return false;
  }
  for (std::uint32_t i = 0; i < record.columns(); ++i) {
    const fb::Column& column = *chunk.columns()->Get(record.first_column() + i);
    const bool one_row = column.field() == fb::Field::Shape || column.field() == fb::Field::Info;
    if (!column_fits(column, bytes, one_row ? 1 : record.rows())) return false;
  }
  return true;
}

bool accepts_bulk(ByteSpan bytes, const fb::ChunkEntry& entry) {
  flatbuffers::Verifier verifier = verifier_for(bytes);
  if (!fb::VerifyBulkChunkBuffer(verifier)) return false;
  const fb::BulkChunk& chunk = *fb::GetBulkChunk(bytes.data());
  if (!is_aligned(chunk.records()) || !is_aligned(chunk.columns())) return false;
  const ByteSpan own{reinterpret_cast<const std::byte*>(chunk.bytes()->data()),
                     chunk.bytes()->size()};
  for (const fb::Record* record : *chunk.records()) {
    if (!record_fits(chunk, *record, own, entry)) return false;
  }
  return true;
}

}  // namespace

bool reference_accepts(ByteSpan chunk, const fb::ChunkEntry& entry) {
  return entry.kind() == fb::PayloadKind::Core ? accepts_core(chunk, entry)
                                               : accepts_bulk(chunk, entry);
}

}  // namespace zonepack::fuzz
