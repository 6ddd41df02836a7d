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

const std::string* nearest_word(std::string_view word, const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  const std::size_t most = word.size() / 3 + 1;
  std::size_t least = most + 1;
  for (const std::string& candidate : known) {
    const std::size_t size = candidate.size();
    if (word.empty() || size > word.size() + most || word.size() > size + most) continue;
    if (const std::size_t distance = edits(word, candidate); distance < least) {
      least = distance;
      nearest = &candidate;
    }
  }
  return nearest;
}

std::string listed(const std::vector<std::string>& known) {
  std::string all;
  for (std::size_t i = 0; i < known.size() && i < kMostShown; ++i) {
    all += (i == 0 ? "" : ", ") + known[i];
  }
  if (known.size() > kMostShown) all += " ...";
  return all.empty() ? "none" : all;
}

std::string known_words_text(std::string_view word, const std::vector<std::string>& known) {
  const std::string* const nearest = nearest_word(word, known);
  return nearest != nullptr ? "; did you mean \"" + *nearest + "\"? Known: " + listed(known)
                            : "; known: " + listed(known);
}

}  // namespace zonepack
