// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace zonepack {

// The known word that is nearest to this one; null when none is near enough (insertions, deletions
// and replacements: at most one more than a third of the word's length).
const std::string* nearest_word(std::string_view word, const std::vector<std::string>& known);

// The end of a message about an unknown word: `; did you mean "b"? Known: a, b, c` when one is near
// enough, else `; known: a, b, c`. At most kMostShown words are listed.
inline constexpr std::size_t kMostShown = 64;
std::string listed(const std::vector<std::string>& known);  // "a, b, c"; "none"
std::string known_words_text(std::string_view word, const std::vector<std::string>& known);

}  // namespace zonepack
