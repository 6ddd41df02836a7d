// SPDX-License-Identifier: Apache-2.0
#include "platform/base/nearest_word.hpp"

#include <algorithm>

namespace zonepack {
namespace {

std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string known_words_text(std::string_view word, const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  const std::size_t most = word.size() / 3 + 1;
  std::size_t least = most + 1;
  std::string all;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (i < kMostShown) all += (i == 0 ? "" : ", ") + known[i];
    if (i == kMostShown) all += " ...";
    const std::size_t size = known[i].size();
    if (word.empty() || size > word.size() + most || word.size() > size + most) continue;
    if (const std::size_t distance = edits(word, known[i]); distance < least) {
      least = distance;
      nearest = &known[i];
    }
  }
  if (all.empty()) all = "none";
  return nearest != nullptr ? "; did you mean \"" + *nearest + "\"? Known: " + all
                            : "; known: " + all;
}

}  // namespace zonepack
