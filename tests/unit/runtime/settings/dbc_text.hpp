// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "runtime/settings/dbc_file.hpp"

// DBC files as texts, and what is found in them.
namespace zonepack::testing_support {

inline LoadedDbc parse(const std::string& text) { return parse_dbc(text, "a.dbc"); }

inline std::vector<std::string> slips_and_faults(const std::string& text) {
  LoadedDbc loaded = parse(text);
  std::vector<std::string> all = std::move(loaded.faults);
  all.insert(all.end(), loaded.slips.begin(), loaded.slips.end());
  return all;
}

// A message of 8 bytes, id 100, with the given signals.
inline std::string message(const std::string& signals) {
  return "BO_ 100 M: 8 N\n" + signals + "\n";
}

inline DbcFound find(const LoadedDbc& loaded, const std::string& name) {
  const auto found = loaded.file.find(name);
  EXPECT_TRUE(found.ok()) << found.error().message;
  return found ? *found : DbcFound{};
}

inline std::string fault_of(const LoadedDbc& loaded, const std::string& name) {
  const auto found = loaded.file.find(name);
  EXPECT_FALSE(found.ok()) << name;
  return found.error().message;
}

inline CanFrame frame(std::uint32_t id, std::initializer_list<int> bytes) {
  CanFrame made;
  made.id = id;
  for (const int byte : bytes) made.data[made.len++] = static_cast<std::uint8_t>(byte);
  return made;
}

}  // namespace zonepack::testing_support
