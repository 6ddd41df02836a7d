// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/yaml_value.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace zonepack {
namespace {

constexpr std::uint32_t kFirstChoice = 1;  // kind 0, the core, is always loaded

const char* kind_word(std::uint32_t kind) { return to_string(static_cast<fb::PayloadKind>(kind)); }

std::string excerpt(std::string_view text) {
  return std::string(1, '"').append(text.substr(0, 60)).append(1, '"');
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

// "0.01 to 20 m".
std::string allowed_text(const FieldLimits& limits) {
  std::string text = number_text(limits.least) + " to " + number_text(limits.most);
  if (*limits.unit != '\0') text += " " + std::string(limits.unit);
  return text;
}

// One overload for each kind of value.
struct ValueParser {
  const YAML::Node& node;
  const FieldLimits& limits;

  Outcome<void> out_of_range() const {
    return failure(node.Scalar() + " is out of range; allowed: " + allowed_text(limits));
  }

  Outcome<void> operator()(double* into) const {
    double number = 0;
    if (!is_plain(node) || !parse_double(node.Scalar(), number)) {
      return failure(shown(node) + " is not a number; allowed: " + allowed_text(limits));
    }
    if (number < limits.least || number > limits.most) return out_of_range();
    *into = number;
    return {};
  }

  Outcome<void> operator()(std::uint64_t* into) const {
    std::uint64_t number = 0;
    if (!is_plain(node) || !parse_integer(node.Scalar(), number)) {
      double real = 0;
      const bool low = is_plain(node) && parse_double(node.Scalar(), real) && real < limits.least;
      return failure(shown(node) + (low ? " is out of range" : " is not a whole number") +
                     "; allowed: " + allowed_text(limits));
    }
    const auto real = static_cast<double>(number);
    if (real < limits.least || real > limits.most) return out_of_range();
    *into = number;
    return {};
  }

  Outcome<void> operator()(std::uint32_t* into) const {
    std::uint64_t wide = 0;
    const FieldLimits narrow{limits.least, std::min(limits.most, 4294967295.0), limits.unit};
    auto parsed = ValueParser{node, narrow}(&wide);
    if (parsed) *into = static_cast<std::uint32_t>(wide);
    return parsed;
  }

  Outcome<void> operator()(bool* into) const {
    if (!is_plain(node) || (node.Scalar() != "true" && node.Scalar() != "false")) {
      return failure(shown(node) + " is not true or false");
    }
    *into = node.Scalar() == "true";
    return {};
  }

  Outcome<void> operator()(std::string* into) const {
    if (!node.IsScalar() && !node.IsNull()) {
      return failure(shown(node) + " where a text is expected");
    }
    *into = node.IsNull() ? std::string() : node.Scalar();
    return {};
  }

  Outcome<void> operator()(std::vector<std::string>* into) const {
    if (!node.IsSequence() && !node.IsNull()) {
      return failure(shown(node) + " where a list [a, b] is expected");
    }
    into->clear();
    for (const YAML::Node& item : node) {
      if (!item.IsScalar()) return failure(shown(item) + " in a list of texts");
      into->push_back(item.Scalar());
    }
    return {};
  }

  Outcome<void> operator()(std::optional<ByteCount>* into) const {
    const std::optional<ByteCount> size =
        node.IsScalar() ? parse_byte_count(node.Scalar()) : std::nullopt;
    if (!size || *size == 0) {
      return failure(
          shown(node) +
          " is not a size; allowed: a whole number of bytes over 0, or a number with KiB, MiB or "
          "GiB (24MiB, 6.8MiB), K, M or G (the same), kB, MB or GB (of 1000)");
    }
    *into = size;
    return {};
  }

  Outcome<void> operator()(PayloadChoice* into) const {
    const std::string allowed = "; allowed: a list of " + payload_words(kEveryPayload);
    if (!node.IsSequence()) return failure(shown(node) + " where a list is expected" + allowed);
    PayloadMask mask = kCoreOnly;
    for (const YAML::Node& item : node) {
      std::uint32_t kind = kFirstChoice;
      while (kind < kPayloadKinds && !(item.IsScalar() && item.Scalar() == kind_word(kind))) ++kind;
      if (kind == kPayloadKinds) return failure(shown(item) + " is not a payload" + allowed);
      mask |= PayloadMask{1} << kind;
    }
    into->mask = mask;
    return {};
  }

  template <typename Enum>
  Outcome<void> operator()(Enum* into) const {
    std::string words;
    std::uint8_t number = 0;
    for (const char* word : EnumWords<Enum>::kWords) {
      if (node.IsScalar() && node.Scalar() == word) {
        *into = static_cast<Enum>(number);
        return {};
      }
      words += (number++ == 0 ? "" : ", ") + std::string(word);
    }
    return failure(shown(node) + " is not one of: " + words);
  }
};

}  // namespace

Outcome<void> parse_value(const YAML::Node& node, const FieldLimits& limits,
                          const FieldValue& into) {
  return std::visit(ValueParser{node, limits}, into);
}

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return excerpt(node.Scalar());
  if (node.IsSequence()) return "a list";
  if (node.IsMap()) return "a section";
  return "nothing";
}

std::string number_text(double value) {
  const double size = std::abs(value);
  const bool handy = size == 0 || (size >= 1e-4 && size < 1e10);
  char text[32];
  const auto format = handy ? std::chars_format::fixed : std::chars_format::scientific;
  const auto [end, error] = std::to_chars(text, text + sizeof text, value, format);
  return {text, end};
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
