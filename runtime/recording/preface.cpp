// SPDX-License-Identifier: Apache-2.0
#include "runtime/recording/preface.hpp"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "platform/base/require.hpp"
#include "runtime/recording/block.hpp"
#include "runtime/recording/input_record.hpp"

namespace zonepack {
namespace {

enum class Field : std::uint8_t {
  kProgram = 1,
  kRealtime = 2,
  kSettingsPath = 3,
  kSettings = 4,
  kMapFolder = 5,
  kManifest = 6,
  kTerms = 7,
  kPinned = 8,
  kStart = 9,
  kDbc = 10,
  kTransitions = 11,
};

constexpr std::size_t kBlockContent = std::size_t{512} * 1024;
constexpr std::size_t kPrefaceRoom = 1024;

ByteSpan bytes_of(std::string_view text) noexcept { return std::as_bytes(std::span(text)); }

std::string text_of(ByteSpan bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::size_t room_for(const RecordingPreface& preface) {
  std::size_t room = kPrefaceRoom + preface.program.size() + preface.settings_path.size() +
                     preface.settings.size() + preface.dbc.size() + preface.map_folder.size() +
                     preface.manifest.size();
  if (preface.terms.learned) room += write_transitions(*preface.terms.learned).size();
  for (const std::string& name : preface.terms.pinned) room += kPrefaceRoom + name.size();
  return room;
}

void put(ByteWriter& out, Field field, ByteSpan bytes) {
  out.u8(static_cast<std::uint8_t>(field));
  out.varint(bytes.size());
  out.bytes(bytes);
}

template <typename Write>
void put(ByteWriter& out, Field field, Write write) {
  out.u8(static_cast<std::uint8_t>(field));
  const std::size_t start = out.begin_counted();
  write(out);
  out.end_counted(start);
}

void put_all(const RecordingPreface& preface, ByteWriter& out) {
  put(out, Field::kProgram, bytes_of(preface.program));
  put(out, Field::kRealtime, [&](ByteWriter& field) { field.i64(preface.realtime_ns); });
  put(out, Field::kSettingsPath, bytes_of(preface.settings_path));
  put(out, Field::kSettings, bytes_of(preface.settings));
  if (!preface.dbc.empty()) put(out, Field::kDbc, bytes_of(preface.dbc));
  put(out, Field::kMapFolder, bytes_of(preface.map_folder));
  put(out, Field::kManifest, ByteSpan(preface.manifest));
  put(out, Field::kTerms, [&](ByteWriter& field) {
    const MapTerms& terms = preface.terms;
    field.u8(terms.budget.has_value());
    field.u64(terms.budget.value_or(0));
    field.u64(terms.max_signatures);
    field.u64(terms.rates.storage);
    field.u64(terms.rates.decode);
    field.i64(terms.period_ns);
    field.i64(terms.lease_ns);
  });
  if (preface.terms.learned) {
    const std::vector<std::byte> learned = write_transitions(*preface.terms.learned);
    put(out, Field::kTransitions, ByteSpan(learned));
  }
  for (const std::string& name : preface.terms.pinned) put(out, Field::kPinned, bytes_of(name));
  if (!preface.start) return;
  put(out, Field::kStart, [&](ByteWriter& field) {
    const RunStart& start = *preface.start;
    field.i64(start.now_ns);
    field.f64(start.T_map_base.x_m);
    field.f64(start.T_map_base.y_m);
    field.f64(start.T_map_base.yaw_rad);
    field.u8(start.sigma_m.has_value());
    field.f64(start.sigma_m.value_or(0));
    field.f64(start.sigma_rad.value_or(0));
  });
}

bool read_terms(ByteReader in, MapTerms& terms) {
  const bool has_budget = in.u8() != 0;
  const ByteCount budget = in.u64();
  if (has_budget) terms.budget = budget;
  terms.max_signatures = in.u64();
  terms.rates.storage = in.u64();
  terms.rates.decode = in.u64();
  terms.period_ns = in.i64();
  terms.lease_ns = in.i64();
  constexpr std::uint64_t kMostRate = 1'000'000'000'000;
  constexpr std::int64_t kHour_ns = 3'600'000'000'000;
  const auto is_rate = [](std::uint64_t rate) { return rate >= 1 && rate <= kMostRate; };
  return in.finished() && is_rate(terms.rates.storage) && is_rate(terms.rates.decode) &&
         terms.period_ns >= 1 && terms.period_ns <= kHour_ns && terms.lease_ns >= 0 &&
         terms.lease_ns <= 1000 * kHour_ns;
}

bool read_start(ByteReader in, std::optional<RunStart>& into) {
  RunStart start;
  start.now_ns = in.i64();
  start.T_map_base = {in.f64(), in.f64(), in.f64()};
  const bool has_sigma = in.u8() != 0;
  const double sigma_m = in.f64(), sigma_rad = in.f64();
  if (has_sigma) {
    start.sigma_m = sigma_m;
    start.sigma_rad = sigma_rad;
  }
  into = start;
  return in.finished() && is_place(start.T_map_base, sigma_m, sigma_rad);
}

Result<void> read_field(std::uint8_t kind, ByteSpan bytes, RecordingPreface& preface) {
  bool good = true;
  switch (static_cast<Field>(kind)) {
    case Field::kProgram:
      preface.program = text_of(bytes);
      break;
    case Field::kRealtime: {
      ByteReader in(bytes);
      preface.realtime_ns = in.i64();
      good = in.finished();
      break;
    }
    case Field::kSettingsPath:
      preface.settings_path = text_of(bytes);
      break;
    case Field::kSettings:
      preface.settings = text_of(bytes);
      break;
    case Field::kDbc:
      preface.dbc = text_of(bytes);
      break;
    case Field::kMapFolder:
      preface.map_folder = text_of(bytes);
      break;
    case Field::kManifest:
      preface.manifest.assign(bytes.begin(), bytes.end());
      break;
    case Field::kTerms:
      good = read_terms(ByteReader(bytes), preface.terms);
      break;
    case Field::kPinned:
      preface.terms.pinned.push_back(text_of(bytes));
      break;
    case Field::kTransitions: {
      auto learned = read_transitions(bytes);
      good = learned.ok();
      if (!good) break;
      preface.terms.learned = std::make_shared<LearnedTransitions>(std::move(learned).value());
      break;
    }
    case Field::kStart:
      good = read_start(ByteReader(bytes), preface.start);
      break;
    default:
      if (kind < kFirstNoteKind) return {ErrorCode::kBadVersion, kind};
  }
  if (!good) return {ErrorCode::kBadStructure, kind};
  return {};
}

}  // namespace

void write_preface(const RecordingPreface& preface,
                   const std::function<void(ByteSpan block)>& take_block) {
  std::vector<std::byte> content(room_for(preface));
  ByteWriter out(content);
  put_all(preface, out);
  ZP_REQUIRE(out.ok());
  std::vector<std::byte> block;
  for (ByteSpan rest = out.written(); !rest.empty();) {
    const ByteSpan part = rest.first(std::min(rest.size(), kBlockContent));
    seal_block(BlockKind::kPreface, part, block);
    take_block(block);
    rest = rest.subspan(part.size());
  }
}

Result<RecordingPreface> read_preface(ByteSpan content) {
  RecordingPreface preface;
  ByteReader in(content);
  while (in.ok() && !in.at_end()) {
    const std::uint8_t kind = in.u8();
    const ByteSpan bytes = in.bytes(in.varint());
    if (!in.ok()) break;
    if (const Result<void> read = read_field(kind, bytes, preface); !read) return read.error();
  }
  if (!in.finished() || preface.manifest.empty()) return ErrorCode::kBadStructure;
  return preface;
}

}  // namespace zonepack
