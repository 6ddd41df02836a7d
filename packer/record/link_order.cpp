// SPDX-License-Identifier: Apache-2.0
#include "packer/record/link_order.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

namespace zonepack::packer {

// Sorts places instead of links, which are large.
void sort_links(std::vector<Link>& links) {
  const auto key = [&links](std::size_t i) { return std::tie(links[i].type, links[i].to); };
  std::vector<std::size_t> order(links.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&key](std::size_t a, std::size_t b) { return key(a) < key(b); });
  if (std::is_sorted(order.begin(), order.end())) return;
  std::vector<Link> sorted;
  sorted.reserve(links.size());
  for (const std::size_t i : order) sorted.push_back(std::move(links[i]));
  links = std::move(sorted);
}

}  // namespace zonepack::packer
