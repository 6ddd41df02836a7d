// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/yaml_section.hpp"

#include "platform/base/nearest_word.hpp"
#include "runtime/settings/yaml_value.hpp"

namespace zonepack {

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

void YamlSection::read(const char* key, const FieldLimits& limits, const FieldValue& into) {
  const YAML::Node node = take(key);
  if (!node.IsDefined()) return;
  const auto parsed = parse_value(node, limits, into);
  if (!parsed) faults_.add(node.Mark(), path_of(key), parsed.error().message);
}

void YamlSection::finish() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (asked_[i]) continue;
    const std::string& key = entries_[i].first;
    faults_.add(key_marks_[i], path_of(key), "unknown key" + known_words_text(key, known_));
  }
}

}  // namespace zonepack
