// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "runtime/memory/eviction_order.hpp"

// Eviction orders of the literature, for comparison; a robot runs none of them. A use of a zone is
// a request that finds it resident: that it became wanted, for whatever reason. Ties go to the zone
// that was used least recently. All numbers are integers.
namespace zonepack {

// Least recently used, as Residency does it without an order. One step.
std::unique_ptr<EvictionOrder> make_lru_order(const EvictionPlace& place);

// First in, first out: the zone that has been resident longest. One look at each candidate.
std::unique_ptr<EvictionOrder> make_fifo_order(const EvictionPlace& place);

// Least frequently used since it became resident. One look at each candidate.
std::unique_ptr<EvictionOrder> make_lfu_order(const EvictionPlace& place);

// Greedy-dual size frequency with equal costs (Cherkasova, "Improving WWW proxies performance with
// greedy-dual-size-frequency caching policy", HPL-98-69R1): each zone has a priority
// L + uses / slots, set when it becomes resident (as one use) and at each use, L being the priority
// of the zone evicted last; the lowest goes. One look at each candidate.
std::unique_ptr<EvictionOrder> make_gdsf_order(const EvictionPlace& place);

// S3-FIFO (Yang and others, "FIFO queues are all you need for cache eviction", SOSP 2023), by
// slots: new zones enter a small queue, those remembered by the ghost queue the main one. From the
// small queue, when it holds a tenth of all slots held, or else from the main one, the oldest
// candidate goes; but one of the small queue used more than once moves to the main one, and one of
// the main queue that was used goes to its end with one use less. The ghost queue remembers the
// zones that left the small queue, as many as the main queue holds, at least one. Where the queue
// has no candidate, the other is looked at. At most eight looks at each resident zone.
std::unique_ptr<EvictionOrder> make_s3_fifo_order(const EvictionPlace& place);

// SIEVE (Zhang and others, "SIEVE is simpler than LRU", NSDI 2024): a queue by the time of loading
// and a hand that goes from old to new and around; it clears the mark of each candidate that was
// used since and evicts the first without a mark. Zones that are no candidates are passed over,
// with their marks. At most three looks at each resident zone.
std::unique_ptr<EvictionOrder> make_sieve_order(const EvictionPlace& place);

}  // namespace zonepack
