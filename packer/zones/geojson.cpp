// SPDX-License-Identifier: Apache-2.0
#include "packer/zones/geojson.hpp"

#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace zonepack::packer {
namespace {

using nlohmann::json;

// GeoJSON needs 8 levels; copying and printing a value take stack for each one.
constexpr int kMaxDepth = 64;
struct TooDeep {};
struct TooLarge {
  std::string what;
};

// Feeds the text to the JSON parser and counts the lines consumed.
class LineCountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  LineCountingIterator(const char* at, std::size_t* line) : at_(at), line_(line) {}
  reference operator*() const { return *at_; }
  LineCountingIterator& operator++() {
    if (*at_++ == '\n') ++*line_;
    return *this;
  }
  LineCountingIterator operator++(int) {
    LineCountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const LineCountingIterator& a, const LineCountingIterator& b) {
    return a.at_ == b.at_;
  }

 private:
  const char* at_;
  std::size_t* line_;
};

// Watches the parser: records where each feature begins, and reports duplicate keys.
class ParseObserver {
 public:
  ParseObserver(const std::size_t& line, Findings& findings) : line_(line), findings_(findings) {}

  bool operator()(int depth, json::parse_event_t event, const json& parsed) {
    if (depth > kMaxDepth) throw TooDeep{};
    const bool begins = event == json::parse_event_t::value ||
                        event == json::parse_event_t::array_start ||
                        event == json::parse_event_t::object_start;
    if (begins && ++values_ > kMaxJsonValues) {
      throw TooLarge{"more than " + std::to_string(kMaxJsonValues) + " values"};
    }
    switch (event) {
      case json::parse_event_t::object_start:
        if (depth == 2 && section_ == "features") feature_lines_.push_back(line_);
        keys_.emplace_back();
        break;
      case json::parse_event_t::object_end:
        keys_.pop_back();
        break;
      case json::parse_event_t::key: {
        const auto& key = parsed.get_ref<const std::string&>();
        if (depth == 1) section_ = key;
        if (!keys_.back().names.insert(key).second) report_twice(key);
        if (++keys_.back().count > kMaxJsonKeys) {
          throw TooLarge{"an object of more than " + std::to_string(kMaxJsonKeys) + " keys"};
        }
        break;
      }
      default:
        break;
    }
    return true;
  }

  const std::vector<std::size_t>& feature_lines() const { return feature_lines_; }

 private:
  void report_twice(const std::string& key) {
    std::optional<std::size_t> feature;
    if (keys_.size() > 1 && section_ == "features" && !feature_lines_.empty()) {
      feature = feature_lines_.size() - 1;
    }
    findings_.faults.push_back(
        {feature, line_, "", "key \"" + key + "\" stands twice in one object; remove one"});
  }

  const std::size_t& line_;
  Findings& findings_;
  std::string section_;
  struct Keys {
    std::set<std::string> names;
    std::size_t count = 0;
  };
  std::vector<Keys> keys_;
  std::size_t values_ = 0;
  std::vector<std::size_t> feature_lines_;
};

// nlohmann's message without its "[json.exception.…]" mark and line, which the finding has.
std::string plain_reason(const std::string& what) {
  std::size_t from = what.find("] ");
  from = from == std::string::npos ? 0 : from + 2;
  if (const std::size_t column = what.find("column ", from); column != std::string::npos) {
    return "column " + what.substr(column + 7);
  }
  return what.substr(from);
}

}  // namespace

std::vector<GeoJsonFeature> read_features(std::string_view text, Findings& findings) {
  const auto fault = [&](std::size_t line, std::string message) {
    findings.faults.push_back({std::nullopt, line, "", std::move(message)});
  };
  std::size_t line = 1;
  ParseObserver observer(line, findings);
  json root;
  try {
    root = json::parse(LineCountingIterator(text.data(), &line),
                       LineCountingIterator(text.data() + text.size(), &line),
                       [&](int depth, json::parse_event_t event, json& parsed) {
                         return observer(depth, event, parsed);
                       });
  } catch (const TooDeep&) {
    fault(line,
          "nested more than " + std::to_string(kMaxDepth) + " levels deep; this is no drawing");
    return {};
  } catch (const TooLarge& found) {
    fault(line, "holds " + found.what + ", too many for a drawing; simplify it");
    return {};
  } catch (const json::parse_error& error) {
    fault(line, "not valid JSON: " + plain_reason(error.what()));
    return {};
  } catch (const json::exception& error) {  // a number too large for a double
    fault(line, "not usable: " + plain_reason(error.what()));
    return {};
  }
  if (!root.is_object() || root.value("type", json()) != "FeatureCollection") {
    fault(1,
          "expected a GeoJSON object with \"type\": \"FeatureCollection\"; export the zones as "
          "GeoJSON");
    return {};
  }
  const auto list = root.find("features");
  if (list == root.end() || !list->is_array()) {
    fault(1, "expected \"features\": [ … ], the list of zones and portals");
    return {};
  }
  std::vector<GeoJsonFeature> features;
  std::size_t objects = 0;
  for (std::size_t i = 0; i < list->size(); ++i) {
    json& value = (*list)[i];
    const std::size_t at = value.is_object() ? observer.feature_lines().at(objects++) : 0;
    if (value.is_object() && value.value("type", json()) == "Feature") {
      features.push_back({i, at, std::move(value)});
    } else {
      fault(at, "feature " + std::to_string(i) + " is not an object with \"type\": \"Feature\"");
    }
  }
  return features;
}

}  // namespace zonepack::packer
