// SPDX-License-Identifier: Apache-2.0
#include "packer/verify/problem.hpp"

namespace zonepack::packer {
namespace {

nlohmann::ordered_json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(text);
}

}  // namespace

std::string to_string(const Problem& problem) {
  const Location& place = problem.place;
  std::string where;
  const auto add = [&where](const std::string& more) {
    where += (where.empty() ? "" : ", ") + more;
  };
  if (!place.zone.empty()) add("zone " + place.zone);
  if (place.chunk) {
    add("chunk " + std::to_string(*place.chunk) +
        (place.kind.empty() ? std::string() : " (" + place.kind + ")"));
  }
  if (place.offset)
    where += (where.empty() ? "at byte " : " at byte ") + std::to_string(*place.offset);
  return place.file + ": " + where + (where.empty() ? "" : ": ") + problem.text + "; " +
         problem.remedy;
}

Problem unlisted(Location place, std::uint64_t count) {
  return {std::move(place),
          "and " + std::to_string(count) + (count == 1 ? " more problem" : " more problems"),
          "see to those that are listed, then verify again", count};
}

nlohmann::ordered_json to_json(const Problem& problem) {
  const Location& place = problem.place;
  nlohmann::ordered_json json;
  json["file"] = place.file;
  json["zone"] = text_or_null(place.zone);
  json["chunk"] = place.chunk ? nlohmann::ordered_json(*place.chunk) : nlohmann::ordered_json();
  json["kind"] = text_or_null(place.kind);
  json["offset"] = place.offset ? nlohmann::ordered_json(*place.offset) : nlohmann::ordered_json();
  json["problem"] = problem.text;
  json["remedy"] = problem.remedy;
  return json;
}

std::string kind_text(fb::PayloadKind kind) {
  const char* const word = zonepack::to_string(kind);
  return word == nullptr ? std::to_string(static_cast<int>(kind)) : word;
}

}  // namespace zonepack::packer
