// SPDX-License-Identifier: Apache-2.0
#include "packer/verify/pack_verifier.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "packer/decode/record_decoder.hpp"
#include "packer/verify/chunk_checks.hpp"
#include "platform/base/failure.hpp"
#include "runtime/pack_format/zone_view.hpp"

namespace zonepack::packer {
namespace {

struct alignas(64) Slot {
  std::byte bytes[kSlotBytes];
};

class PackVerifier {
 public:
  PackVerifier(const MapFile& file, const std::string& name, Problems& problems)
      : file_(file), name_(name), problems_(problems) {}

  std::optional<PackFacts> run() {
    if (!read_frame()) return std::nullopt;
    facts_.zone = index_->zone()->str();
    facts_.bytes = file_.size();
    facts_.digest = tail_.digest;
    facts_.grid_needs_scan = index_->grid_needs_scan();
    bool whole = true;
    for (std::uint32_t i = 0; i < index_->chunks()->size(); ++i) {
      whole = read_chunk(i, *index_->chunks()->Get(i)) && whole;
    }
    if (whole) check_signatures();
    if (found_ > kMostListed) {
      problems_.push_back(
          unlisted({.file = name_, .zone = index_->zone()->str()}, found_ - kMostListed));
    }
    return std::move(facts_);
  }

 private:
  void report(Location place, const std::string& text, const char* remedy) {
    if (++found_ > kMostListed) return;
    place.file = name_;
    if (index_ != nullptr) place.zone = index_->zone()->str();
    problems_.push_back({std::move(place), text, remedy});
  }
  void report_at(std::uint64_t offset, const std::string& text, const char* remedy) {
    report({.offset = offset}, text, remedy);
  }

  bool read(std::uint64_t offset, std::span<std::byte> out, const char* what) {
    const Result<void> read = file_.read_at(offset, out);
    if (read) return true;
    report_at(offset, std::string(what) + " cannot be read: " + reason_text(read.error()),
              kCopyAgain);
    return false;
  }

  bool read_frame();
  bool read_index(ByteSpan header);
  bool read_chunk(std::uint32_t place, const fb::ChunkEntry& entry);
  void check_signatures();
  void check_bounds();
  void check_claims();

  const MapFile& file_;
  const std::string& name_;
  Problems& problems_;
  PackTail tail_;
  std::vector<std::uint64_t> words_;  // the index, aligned
  const fb::PackIndex* index_ = nullptr;
  std::vector<std::unique_ptr<Slot>> memory_;
  std::vector<ChunkRef> chunks_;
  bool refers_to_scan_ = false;
  std::uint64_t found_ = 0;  // problems
  PackFacts facts_;
};

bool PackVerifier::read_frame() {
  constexpr std::uint64_t kFrame = sizeof(PackHeader) + sizeof(PackTail);
  if (file_.size() < kFrame) {
    report_at(file_.size(),
              "the file ends after " + std::to_string(file_.size()) +
                  " bytes; header and tail alone take " + std::to_string(kFrame),
              kCopyAgain);
    return false;
  }
  std::array<std::byte, sizeof(PackHeader)> header;
  std::array<std::byte, sizeof(PackTail)> last;
  const std::uint64_t tail_at = file_.size() - last.size();
  if (!read(0, header, "the header") || !read(tail_at, last, "the tail")) return false;
  const Result<PackTail> tail = check_tail(last, file_.size());
  if (!tail) {
    const Error error = tail.error();
    report_at(tail_at,
              error.code == ErrorCode::kBadMagic
                  ? "the file does not end as a pack does: it was cut off or is no pack"
              : error.code == ErrorCode::kBadVersion
                  ? "format version " + std::to_string(error.detail) + ", this program reads " +
                        std::to_string(kPackMajor)
              : excess_of(error)
                  ? index_fault_text(error)
                  : "the tail places the index at byte " + std::to_string(error.detail) +
                        ", which is not where a file of this length has it",
              kCopyAgain);
    return false;
  }
  tail_ = *tail;
  return read_index(header);
}

bool PackVerifier::read_index(ByteSpan header) {
  const auto size = static_cast<std::size_t>(tail_.index_size);
  words_.resize((size + 7) / 8);
  const auto index = std::as_writable_bytes(std::span(words_)).first(size);
  if (!read(tail_.index_offset, index, "the index")) return false;
  const Result<const fb::PackIndex*> checked = check_index(header, index, tail_);
  if (!checked) {
    const Error error = checked.error();
    switch (error.code) {
      case ErrorCode::kBadMagic:
        report_at(0, "the file does not begin as a pack does", kCopyAgain);
        break;
      case ErrorCode::kBadVersion:
        report_at(0,
                  "format version " + std::to_string(error.detail) + ", this program reads " +
                      std::to_string(kPackMajor),
                  kCopyAgain);
        break;
      case ErrorCode::kBadChecksum:
        report_at(tail_.index_offset,
                  "header, index and tail do not have the BLAKE2b-256 that the tail holds",
                  kCopyAgain);
        break;
      default:
        report_at(tail_.index_offset, index_fault_text(error), kBuildAgain);
    }
    return false;
  }
  index_ = *checked;
  PackHeader front;
  std::memcpy(&front, header.data(), sizeof front);
  if (front.major != tail_.major || front.minor != tail_.minor) {
    report_at(8, "header and tail name different format versions", kBuildAgain);
  }
  if (front.minor <= kPackMinor && (front.reserved != 0 || tail_.reserved != 0)) {
    report_at(12, "a reserved field of header or tail is not zero", kBuildAgain);
  }
  return true;
}

bool PackVerifier::read_chunk(std::uint32_t place, const fb::ChunkEntry& entry) {
  const char* const kind = zonepack::to_string(entry.kind());
  const auto fail = [&](const std::string& text, const char* remedy) {
    report({.chunk = place,
            .kind = kind == nullptr ? "kind " + std::to_string(static_cast<int>(entry.kind()))
                                    : std::string(kind),
            .offset = entry.offset()},
           text, remedy);
    return false;
  };
  PackFacts::Payload& payload = facts_.payloads[static_cast<std::size_t>(entry.kind())];
  payload.decoded += entry.decoded_size();
  payload.stored += entry.stored_size();
  ++payload.chunks;
  facts_.chunks.emplace_back(entry.kind(), entry.decoded_size());

  std::vector<std::byte> stored(entry.stored_size());
  if (const Result<void> read = file_.read_at(entry.offset(), stored); !read) {
    return fail("the stored bytes cannot be read: " + reason_text(read.error()), kCopyAgain);
  }
  const bool accident = xxh3(stored) != entry.xxh3();
  const Digest16 digest = blake2b_16(stored);
  const bool intent = !std::equal(digest.begin(), digest.end(), entry.digest()->begin());
  if (accident || intent) {
    return fail(std::string("the ") + std::to_string(stored.size()) +
                    " stored bytes do not have the " +
                    (accident && intent ? "XXH3 and BLAKE2b"
                     : accident         ? "XXH3"
                                        : "BLAKE2b") +
                    " that the index holds",
                kCopyAgain);
  }
  if (kind == nullptr) return true;  // of a newer version: nothing more can be checked
  auto slot = std::make_unique_for_overwrite<Slot>();
  const Result<ByteSpan> decoded = decode_chunk(entry, stored, slot->bytes);
  if (!decoded) {
    return fail(
        decoded.error().code == ErrorCode::kBadCompression
            ? "the LZ4 block does not decode to " + std::to_string(entry.decoded_size()) + " bytes"
        : excess_of(decoded.error())
            ? to_string(*excess_of(decoded.error()))
            : "the decoded chunk breaks the rules of the format: " + reason_text(decoded.error()),
        kBuildAgain);
  }
  if (const auto problem = find_chunk_problem(entry, *decoded)) {
    return fail("the decoded chunk " + *problem, kBuildAgain);
  }
  refers_to_scan_ = refers_to_scan_ || refers_to_scan(entry, *decoded);
  chunks_.push_back({entry.kind(), *decoded});
  memory_.push_back(std::move(slot));
  return true;
}

void PackVerifier::check_signatures() {
  const Result<ZoneView> view = ZoneView::make(chunks_);
  if (!view) {
    report({},
           "signature number " + std::to_string(view.error().detail) +
               ": its tables leave out, repeat or contradict rows, it has no core, or its id is "
               "not above the one before",
           kBuildAgain);
    return;
  }
  facts_.complete = true;
  facts_.grid_needs_scan = refers_to_scan_;
  for (std::uint32_t i = 0; i < view->size(); ++i) {
    SignatureRecord record;
    try {
      record = decode_record(*view, i);
    } catch (const std::runtime_error& error) {
      report({}, error.what(), kBuildAgain);
      facts_.complete = false;
      continue;
    }
    const std::optional<Transform>& base = record.pose ? record.pose : record.odometry_pose;
    if (!base) {
      report({}, "signature " + std::to_string(record.id) + " has no pose at all", kBuildAgain);
      facts_.complete = false;
      continue;
    }
    facts_.features += record.features.count;
    facts_.nodes.push_back({record.id, *base});
    for (const Link& link : record.links) facts_.links.emplace_back(record.id, link.to);
  }
  if (!facts_.complete) return;
  check_claims();
  check_bounds();
}

void PackVerifier::check_claims() {
  const auto compare = [&](const char* what, std::uint64_t said, std::uint64_t found) {
    if (said == found) return;
    report_at(tail_.index_offset,
              std::string("the index says ") + what + " " + std::to_string(said) +
                  ", the chunks hold " + std::to_string(found),
              kBuildAgain);
  };
  compare("signatures", index_->signatures(), facts_.nodes.size());
  compare("features", index_->features(), facts_.features);
  compare("grid_needs_scan", index_->grid_needs_scan(), facts_.grid_needs_scan);
}

void PackVerifier::check_bounds() {
  for (std::uint32_t i = 0; i < index_->chunks()->size(); ++i) {
    const fb::ChunkEntry& entry = *index_->chunks()->Get(i);
    if (entry.last_signature() >= facts_.nodes.size()) continue;  // reported by check_claims()
    const auto position = [this](std::uint32_t ordinal) {
      const Transform& T = facts_.nodes[ordinal].T_map_base;
      return std::pair(T[3], T[7]);
    };
    auto [min_x, min_y] = position(entry.first_signature());
    auto [max_x, max_y] = position(entry.first_signature());
    for (std::uint32_t k = entry.first_signature(); k <= entry.last_signature(); ++k) {
      const auto [x, y] = position(k);
      min_x = std::min(min_x, x);
      max_x = std::max(max_x, x);
      min_y = std::min(min_y, y);
      max_y = std::max(max_y, y);
    }
    if (entry.min_x() == min_x && entry.max_x() == max_x && entry.min_y() == min_y &&
        entry.max_y() == max_y) {
      continue;
    }
    const char* const kind = zonepack::to_string(entry.kind());
    report({.chunk = i, .kind = kind == nullptr ? "" : kind, .offset = entry.offset()},
           "the bounds in the index are not those of the chunk's signatures", kBuildAgain);
  }
}

}  // namespace

std::optional<PackFacts> verify_pack(const MapFile& file, const std::string& name,
                                     Problems& problems) {
  return PackVerifier(file, name, problems).run();
}

}  // namespace zonepack::packer
