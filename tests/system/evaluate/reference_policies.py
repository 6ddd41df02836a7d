# SPDX-License-Identifier: Apache-2.0
"""The eviction policies of `zoned evaluate`, written a second time in the plainest way, from their papers.

check(policy, csv) follows a trace of --trace-csv: it takes from it what was requested, loaded and held, chooses who is
evicted by itself, and returns (requests, hits, evictions), or raises where the trace says another zone.
"""
import csv
from fractions import Fraction


class Policy:
    def __init__(self):
        self.clock = 0
        self.used = {}  # last use of each zone: when it was released

    def request(self, zone, resident):
        pass

    def load(self, zone, slots):
        pass

    def gone(self, zone):
        pass

    def coldest(self, zones):
        return min(zones, key=lambda z: self.used[z])


class Lru(Policy):
    def choose(self, candidates):
        return self.coldest(candidates)


class Fifo(Policy):
    def __init__(self):
        super().__init__()
        self.queue = []

    def load(self, zone, slots):
        self.queue.append(zone)

    def gone(self, zone):
        self.queue.remove(zone)

    def choose(self, candidates):
        return next(z for z in self.queue if z in candidates)


class Lfu(Policy):
    def __init__(self):
        super().__init__()
        self.uses = {}

    def request(self, zone, resident):
        if resident:
            self.uses[zone] += 1

    def load(self, zone, slots):
        self.uses[zone] = 1

    def choose(self, candidates):
        least = min(self.uses[z] for z in candidates)
        return self.coldest([z for z in candidates if self.uses[z] == least])


class Gdsf(Policy):
    """Priorities as exact fractions of 2^-24, rounded down as the program's integers are."""

    def __init__(self):
        super().__init__()
        self.age, self.uses, self.size, self.priority = Fraction(0), {}, {}, {}

    def rank(self, zone):
        share = Fraction(self.uses[zone] * 2**24 // max(self.size[zone], 1), 2**24)
        self.priority[zone] = self.age + share

    def request(self, zone, resident):
        if resident:
            self.uses[zone] += 1
            self.rank(zone)

    def load(self, zone, slots):
        self.uses[zone], self.size[zone] = 1, slots
        self.rank(zone)

    def choose(self, candidates):
        self.age = min(self.priority[z] for z in candidates)
        return self.coldest([z for z in candidates if self.priority[z] == self.age])


class S3Fifo(Policy):
    def __init__(self):
        super().__init__()
        self.small, self.main, self.ghost = [], [], []
        self.uses, self.size, self.returns = {}, {}, set()

    def request(self, zone, resident):
        if resident:
            self.uses[zone] = min(self.uses[zone] + 1, 3)
        elif zone in self.ghost:
            self.ghost.remove(zone)
            self.returns.add(zone)

    def load(self, zone, slots):
        self.uses[zone], self.size[zone] = 0, slots
        (self.main if zone in self.returns else self.small).append(zone)
        self.returns.discard(zone)

    def gone(self, zone):
        if zone in self.main:
            self.main.remove(zone)
            return
        self.small.remove(zone)
        self.ghost.append(zone)
        while len(self.ghost) > max(len(self.main), 1):
            self.ghost.pop(0)

    def of_small(self, candidates):
        for zone in list(self.small):
            if zone in candidates:
                if self.uses[zone] <= 1:
                    return zone
                self.small.remove(zone)
                self.main.append(zone)
        return None

    def of_main(self, candidates):
        if not any(zone in candidates for zone in self.main):
            return None
        place = 0
        while True:
            zone = self.main[place]
            if zone not in candidates:
                place += 1
            elif self.uses[zone] > 0:
                self.uses[zone] -= 1
                self.main.append(self.main.pop(place))
            else:
                return zone

    def choose(self, candidates):
        size = sum(self.size[z] for z in self.small)
        every = size + sum(self.size[z] for z in self.main)
        queues = [self.of_main, self.of_small]
        if self.small and size * 10 >= every:
            queues.reverse()
        return queues[0](candidates) or queues[1](candidates) or self.of_main(candidates)


class Sieve(Policy):
    def __init__(self):
        super().__init__()
        self.queue, self.marked, self.hand = [], set(), 0

    def request(self, zone, resident):
        if resident:
            self.marked.add(zone)

    def load(self, zone, slots):
        self.queue.append(zone)
        self.marked.discard(zone)

    def gone(self, zone):
        place = self.queue.index(zone)
        self.queue.pop(place)
        if place < self.hand:
            self.hand -= 1
        if self.hand >= len(self.queue):
            self.hand = 0

    def choose(self, candidates):
        while True:
            zone = self.queue[self.hand]
            if zone in candidates and zone not in self.marked:
                return zone
            if zone in candidates:
                self.marked.discard(zone)
            self.hand = (self.hand + 1) % len(self.queue)


POLICIES = {"lru": Lru, "fifo": Fifo, "lfu": Lfu, "gdsf": Gdsf, "s3-fifo": S3Fifo, "sieve": Sieve}


def check(name, path):
    policy = POLICIES[name]()
    resident, candidates = set(), set()
    requests = hits = evictions = 0
    with open(path, newline="") as file:
        for number, row in enumerate(csv.DictReader(file), 2):
            op, zone = row["op"], row["zone"]
            policy.clock += 1
            if op == "requested":
                requests += 1
                hits += zone in resident
                policy.request(zone, zone in resident)
            elif op == "loaded":
                resident.add(zone)
                policy.load(zone, int(row["slots"]))
            elif op == "released":
                candidates.add(zone)
                policy.used[zone] = policy.clock
            elif op == "held":
                candidates.discard(zone)
            elif op == "evicted":
                evictions += 1
                chosen = policy.choose(candidates)
                if chosen != zone:
                    raise AssertionError(f"{path}:{number}: {name} evicted {zone}, and would evict {chosen} here")
            elif op == "removed":
                resident.discard(zone)
                policy.gone(zone)
            else:
                raise AssertionError(f"{path}:{number}: an op {op}")
    return requests, hits, evictions
