// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/yaml_section.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "platform/base/nearest_word.hpp"

namespace zonepack {
namespace {

std::string excerpt(std::string_view text) {
  return std::string(1, '"').append(text.substr(0, 60)).append(1, '"');
}

// The node's content, for a message.
std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return excerpt(node.Scalar());
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a section";
  return "nothing";
}

// An unquoted scalar.
bool is_plain(const YAML::Node& node) { return node.IsScalar() && node.Tag() != "!"; }

bool parse_double(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

bool parse_integer(std::string_view text, std::uint64_t& value) {
  const int base = text.starts_with("0x") || text.starts_with("0X") ? 16 : 10;
  if (base == 16) text.remove_prefix(2);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return error == std::errc() && end == text.data() + text.size();
}

template <typename Enum>
Outcome<void> parse_word(const YAML::Node& node, Enum& value) {
  std::string words;
  std::uint8_t number = 0;
  for (const char* word : EnumWords<Enum>::kWords) {
    if (node.IsScalar() && node.Scalar() == word) {
      value = static_cast<Enum>(number);
      return {};
    }
    words += (number++ == 0 ? "" : ", ") + std::string(word);
  }
  return failure(shown(node) + " is not one of: " + words);
}

constexpr std::uint32_t kFirstChoice = 1;  // kind 0, the core, is always loaded

const char* kind_word(std::uint32_t kind) { return to_string(static_cast<fb::PayloadKind>(kind)); }

}  // namespace

void FaultList::add(const YAML::Mark& mark, const std::string& path, const std::string& text) {
  std::string fault = file_;
  if (!mark.is_null()) fault += ":" + std::to_string(mark.line + 1);
  fault += ": ";
  if (!path.empty()) fault += path + ": ";
  add_complete(fault + text);
}

void FaultList::add_complete(const std::string& text) {
  if (faults_.size() < kMost) {
    faults_.push_back(text);
  } else {
    ++left_out_;
  }
}

std::vector<std::string> FaultList::take() {
  if (left_out_ > 0) {
    faults_.push_back(file_ + ": and " + std::to_string(left_out_) + " more");
    left_out_ = 0;
  }
  return std::move(faults_);
}

YamlSection::YamlSection(const YAML::Node& node, std::string path, FaultList& faults)
    : path_(std::move(path)), faults_(faults), mark_(node.Mark()) {
  if (!node.IsDefined() || node.IsNull()) return;
  if (!node.IsMap()) {
    faults_.add(mark_, path_, shown(node) + " where keys with values are expected");
    return;
  }
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) {
      faults_.add(entry.first.Mark(), path_, "a key must be a word");
      continue;
    }
    const std::string& key = entry.first.Scalar();
    const auto [same, fresh] = places_.emplace(key, entries_.size());
    if (!fresh) {
      const YAML::Mark first = key_marks_[same->second];
      faults_.add(entry.first.Mark(), path_of(key),
                  "stands here twice, first on line " + std::to_string(first.line + 1));
      continue;
    }
    entries_.emplace_back(key, entry.second);
    key_marks_.push_back(entry.first.Mark());
    asked_.push_back(false);
  }
}

std::string YamlSection::path_of(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

YAML::Node YamlSection::take(std::string_view key) {
  known_.emplace_back(key);
  const auto found = places_.find(key);
  if (found == places_.end()) return YAML::Node(YAML::NodeType::Undefined);
  asked_[found->second] = true;
  return entries_[found->second].second;
}

bool YamlSection::has(std::string_view key) const noexcept {
  return places_.find(key) != places_.end();
}

YAML::Mark YamlSection::mark_of(std::string_view key) const {
  const auto found = places_.find(key);
  return found != places_.end() ? entries_[found->second].second.Mark() : mark_;
}

void YamlSection::finish() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (asked_[i]) continue;
    const std::string& key = entries_[i].first;
    faults_.add(key_marks_[i], path_of(key), "unknown key" + known_words_text(key, known_));
  }
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double least, double most,
                                 const char* unit, double& value) {
  double number = 0;
  if (!is_plain(node) || !parse_double(node.Scalar(), number)) {
    return failure(shown(node) + " is not a number; allowed: " + allowed_text(least, most, unit));
  }
  if (number < least || number > most) {
    return failure(node.Scalar() + " is out of range; allowed: " + allowed_text(least, most, unit));
  }
  value = number;
  return {};
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double least, double most,
                                 const char* unit, std::uint64_t& value) {
  std::uint64_t number = 0;
  if (!is_plain(node) || !parse_integer(node.Scalar(), number)) {
    double real = 0;
    const bool low = is_plain(node) && parse_double(node.Scalar(), real) && real < least;
    return failure(shown(node) + (low ? " is out of range" : " is not a whole number") +
                   "; allowed: " + allowed_text(least, most, unit));
  }
  if (static_cast<double>(number) < least || static_cast<double>(number) > most) {
    return failure(node.Scalar() + " is out of range; allowed: " + allowed_text(least, most, unit));
  }
  value = number;
  return {};
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double least, double most,
                                 const char* unit, std::uint32_t& value) {
  std::uint64_t wide = 0;
  auto parsed = parse(node, least, std::min(most, 4294967295.0), unit, wide);
  if (parsed) value = static_cast<std::uint32_t>(wide);
  return parsed;
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*, bool& value) {
  if (!is_plain(node) || (node.Scalar() != "true" && node.Scalar() != "false")) {
    return failure(shown(node) + " is not true or false");
  }
  value = node.Scalar() == "true";
  return {};
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 std::string& value) {
  if (node.IsNull()) {
    value.clear();
    return {};
  }
  if (!node.IsScalar()) return failure(shown(node) + " where a text is expected");
  value = node.Scalar();
  return {};
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 std::vector<std::string>& value) {
  if (!node.IsSequence() && !node.IsNull())
    return failure(shown(node) + " where a list [a, b] is expected");
  value.clear();
  for (const YAML::Node& item : node) {
    if (!item.IsScalar()) return failure(shown(item) + " in a list of texts");
    value.push_back(item.Scalar());
  }
  return {};
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 std::optional<ByteCount>& value) {
  const std::optional<ByteCount> size =
      node.IsScalar() ? parse_byte_count(node.Scalar()) : std::nullopt;
  if (!size || *size == 0) {
    return failure(
        shown(node) +
        " is not a size; allowed: a whole number of bytes over 0, or a number with KiB, MiB or "
        "GiB (24MiB, 6.8MiB), K, M or G (the same), kB, MB or GB (of 1000)");
  }
  value = size;
  return {};
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 PayloadChoice& value) {
  const std::string allowed = "; allowed: a list of " + payload_words(kEveryPayload);
  if (!node.IsSequence()) return failure(shown(node) + " where a list is expected" + allowed);
  PayloadMask mask = kCoreOnly;
  for (const YAML::Node& item : node) {
    std::uint32_t kind = kFirstChoice;
    while (kind < kPayloadKinds && !(item.IsScalar() && item.Scalar() == kind_word(kind))) ++kind;
    if (kind == kPayloadKinds) return failure(shown(item) + " is not a payload" + allowed);
    mask |= PayloadMask{1} << kind;
  }
  value.mask = mask;
  return {};
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 OdometryModel& value) {
  return parse_word(node, value);
}
Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 WheelUnit& value) {
  return parse_word(node, value);
}
Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 AngleUnit& value) {
  return parse_word(node, value);
}
Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 ByteOrder& value) {
  return parse_word(node, value);
}
Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 SignalType& value) {
  return parse_word(node, value);
}
Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 ReadMode& value) {
  return parse_word(node, value);
}

Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 GpioBias& value) {
  return parse_word(node, value);
}
Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 SafeLevel& value) {
  return parse_word(node, value);
}
Outcome<void> YamlSection::parse(const YAML::Node& node, double, double, const char*,
                                 EvictionRule& value) {
  return parse_word(node, value);
}

std::string number_text(double value) {
  const double size = std::abs(value);
  const bool handy = size == 0 || (size >= 1e-4 && size < 1e10);
  char text[32];
  const auto format = handy ? std::chars_format::fixed : std::chars_format::scientific;
  const auto [end, error] = std::to_chars(text, text + sizeof text, value, format);
  return {text, end};
}

std::string allowed_text(double least, double most, const char* unit) {
  std::string text = number_text(least) + " to " + number_text(most);
  if (*unit != '\0') text += " " + std::string(unit);
  return text;
}

std::string payload_words(PayloadMask mask) {
  std::string words;
  for (std::uint32_t kind = kFirstChoice; kind < kPayloadKinds; ++kind) {
    if ((mask >> kind & 1u) != 0)
      words += (words.empty() ? "" : ", ") + std::string(kind_word(kind));
  }
  return words;
}

}  // namespace zonepack
