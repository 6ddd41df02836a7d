// SPDX-License-Identifier: Apache-2.0
#include "runtime/serve/localizer_board.hpp"

#include <algorithm>
#include <utility>

#include "runtime/pack_format/file/zone_name.hpp"
#include "runtime/protocol/messages.hpp"

namespace zonepack {
namespace {

// Texts are shown on terminals.
bool is_short_text(const flatbuffers::String* text, std::uint32_t most) noexcept {
  return text == nullptr || (text->size() <= most && is_plain_text(view_of(text)));
}

bool is_within_limits(const wire::Localizer& report) noexcept {
  if (!is_short_text(report.camera(), LocalizerBoard::kMostCameraBytes)) return false;
  if (report.reasons() == nullptr) return true;
  return report.reasons()->size() <= LocalizerBoard::kMostReasons &&
         std::all_of(report.reasons()->begin(), report.reasons()->end(),
                     [](const wire::FixReason* one) {
                       return is_short_text(one->reason(), LocalizerBoard::kMostReasonBytes);
                     });
}

flatbuffers::Offset<wire::Localizer> copy_report(flatbuffers::FlatBufferBuilder& to,
                                                 const wire::Localizer& from) {
  std::vector<flatbuffers::Offset<wire::FixReason>> reasons;
  if (from.reasons() != nullptr) {
    for (const wire::FixReason* const one : *from.reasons()) {
      const auto reason = to.CreateString(one->reason());
      reasons.push_back(wire::CreateFixReason(to, reason, one->images()));
    }
  }
  const auto list = to.CreateVector(reasons);
  const auto camera =
      from.camera() != nullptr ? to.CreateString(from.camera()) : to.CreateString("");
  return wire::CreateLocalizer(to, camera, from.images_total(), from.fixes_total(),
                               from.skipped_total(), from.refused_total(), from.latency(),
                               from.query(), list, from.lost_total(), from.searching(),
                               from.search_views(), from.search_zones());
}

}  // namespace

Result<void> LocalizerBoard::take(std::uint64_t client, const wire::Localizer& report) {
  if (!is_within_limits(report)) return ErrorCode::kBadValue;
  flatbuffers::FlatBufferBuilder builder(kMostReportBytes);
  builder.Finish(copy_report(builder, report));
  std::vector<std::uint8_t> bytes(builder.GetBufferPointer(),
                                  builder.GetBufferPointer() + builder.GetSize());
  const auto found = std::ranges::find(rows_, client, &Row::client);
  if (found != rows_.end()) {
    found->report = std::move(bytes);
    return {};
  }
  if (rows_.size() == kMostLocalizers) {
    return {ErrorCode::kTooLarge, static_cast<std::int64_t>(kMostLocalizers)};
  }
  rows_.push_back({client, std::move(bytes)});
  return {};
}

void LocalizerBoard::gone(std::uint64_t client) noexcept {
  std::erase_if(rows_, [client](const Row& row) { return row.client == client; });
}

LocalizerRows LocalizerBoard::put(flatbuffers::FlatBufferBuilder& to) const {
  std::vector<flatbuffers::Offset<wire::Localizer>> reports;
  for (const Row& row : rows_) {
    reports.push_back(copy_report(to, *flatbuffers::GetRoot<wire::Localizer>(row.report.data())));
  }
  return to.CreateVector(reports);
}

}  // namespace zonepack
