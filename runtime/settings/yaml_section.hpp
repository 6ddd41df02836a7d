// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/settings/field.hpp"

namespace zonepack {

// Collects what is wrong with a file, in the order it was found; the first kMost are kept.
class FaultList {
 public:
  explicit FaultList(std::string file) : file_(std::move(file)) {}

  // "file:line: path: text"; without a path "file:line: text", without a place "file: text".
  void add(const YAML::Mark& mark, const std::string& path, const std::string& text);

  // A complete message about another file.
  void add_complete(const std::string& text);

  // What does not stop the settings from being used.
  void add_warning(const std::string& text) { warnings_.push_back(text); }
  std::vector<std::string> take_warnings() { return std::move(warnings_); }

  // Ends with the number of those that were too many to keep.
  std::vector<std::string> take();
  std::size_t size() const noexcept { return faults_.size() + left_out_; }

 private:
  static constexpr std::size_t kMost = 200;

  std::string file_;
  std::vector<std::string> faults_;
  std::vector<std::string> warnings_;
  std::size_t left_out_ = 0;
};

// A mapping of a YAML file, read strictly: a key that was not asked for before finish() is a fault,
// and so is a duplicate key. Works on any node; one that is not a mapping is itself a fault.
class YamlSection {
 public:
  // path: "odometry", empty for the whole file.
  YamlSection(const YAML::Node& node, std::string path, FaultList& faults);

  // The value of a key, or an undefined node. The key counts as known from here on.
  YAML::Node take(std::string_view key);

  // Whether the key is present, with any value. Does not make it known.
  bool has(std::string_view key) const noexcept;

  // The place of a key's value; the section's when the key is absent.
  YAML::Mark mark_of(std::string_view key) const;

  // Reads every field that is present into `into`; the others keep their values.
  template <typename Section>
  void read(const Fields<Section>& fields, Section& into) {
    for (const Field<Section>& field : fields) {
      read(field.key, field.limits(), field.value(into));
    }
  }

  // Adds a fault for every key that was not asked for, with the nearest known one.
  void finish();

  // All keys with their values, for mappings whose keys are names.
  const std::vector<std::pair<std::string, YAML::Node>>& entries() const noexcept {
    return entries_;
  }

  std::string path_of(std::string_view key) const;
  YAML::Mark mark() const { return mark_; }

 private:
  void read(const char* key, const FieldLimits& limits, const FieldValue& into);

  std::string path_;
  FaultList& faults_;
  YAML::Mark mark_;
  std::vector<std::pair<std::string, YAML::Node>> entries_;
  std::map<std::string, std::size_t, std::less<>> places_;  // of the keys in entries_
  std::vector<YAML::Mark> key_marks_;
  std::vector<bool> asked_;
  std::vector<std::string> known_;
};

}  // namespace zonepack
