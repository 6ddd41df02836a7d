#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: tenant_row.py [NAME RUN TRUTH LIMIT_MIB RUN_ALONE TENANT_ALONE]: a row of tenant.sh's table, from the files of
its runs; without arguments the heading. Right: a fix within 0.5 m and 10 degrees of the truth.
"""
import json
import math
import sys
from pathlib import Path

FILLING_S = 3  # the tenant runs before the robot starts
COLUMNS = ("zones, budget", "limit, MiB", "killed: zoned, zoneloc, tenant", "limit hit", "charged, MiB", "robot stalled, %",
           "missed deadlines", "loads", "load, ms: p50, p99, max", "right fixes, wrong, of images",
           "query CPU, ms: p50, p95, max (times alone)", "image to pose, ms: p50, p95, max (times alone)",
           "tenant, MiB/s (of alone)")


def read_json(path):
    """Null where the program was killed before it wrote it."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() and path.stat().st_size else None


def rows(path):
    return [line.split() for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]


def quantile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, math.ceil(share * len(ordered)) - 1)]


def load_times_ms(events):
    """From the decision to the moment at which the zone can be used; what is cut off at the end of a killed run is left."""
    begun, times = {}, []
    for line in events.read_text(encoding="utf-8").splitlines():
        try:
            event = json.loads(line)
        except json.JSONDecodeError:
            break
        if event["event"] == "load_started":
            begun[event["zone"]] = event["t_ns"]
        elif event["event"] == "load_done":
            times.append((event["t_ns"] - begun.pop(event["zone"])) / 1e6)
    return times


def judge(fixes, truth):
    """How many fixes are right, and how many wrong."""
    path = [[float(v) for v in row[:8]] for row in rows(truth)]
    right = total = 0
    for stamp, x, y, yaw in ([float(v) for v in row] for row in rows(fixes)):
        pose = min(path, key=lambda p, at=stamp: abs(p[0] - at))
        off = math.remainder(yaw - 2 * math.atan2(pose[6], pose[7]), 2 * math.pi)
        total += 1
        right += math.hypot(x - pose[1], y - pose[2]) <= 0.5 and abs(off) <= math.radians(10)
    return right, total - right


def spread_text(spread, alone):
    """A time's p50, p95 and max; and how many times what it is without the tenant."""
    keys = ("p50", "p95", "max")
    text = ", ".join(f"{spread[key]:.1f}" for key in keys)
    return text + (f" ({', '.join(f'{spread[key] / alone[key]:.1f}' for key in keys)})" if spread is not alone else "")


def rate(folder, seconds=None):
    """MiB a second: over the lines of the tenant, a second each, or over the given time."""
    lines = rows(folder / "tenant.txt")
    return sum(int(line[0]) for line in lines) / 2**20 / (seconds or len(lines)) if lines else 0


def main():
    if len(sys.argv) == 1:
        print("| " + " | ".join(COLUMNS) + " |")
        print("|" + "---|" * len(COLUMNS))
        return
    name, limit = sys.argv[1], int(sys.argv[4])
    run, truth, alone, tenant = (Path(sys.argv[place]) for place in (2, 3, 5, 6))
    facts = dict(pair.split("=") for pair in (run / "facts").read_text(encoding="utf-8").split())
    zoned, zoneloc = (read_json(run / f"{program}.json") for program in ("zoned", "zoneloc"))
    before = read_json(alone / "zoneloc.json") if limit else zoneloc
    seconds = float(facts["seconds"])
    kills = [int(facts[f"{program}_code"] == "137") for program in ("zoned", "zoneloc")]
    kills.append(len(rows(run / "tenant.kills")) if (run / "tenant.kills").exists() else 0)
    loads = load_times_ms(run / "events.jsonl") if (run / "events.jsonl").exists() else []
    right, wrong = judge(run / "fixes.txt", truth)
    beside = rate(run, seconds + FILLING_S) if limit else 0
    print("| " + " | ".join((
        name, str(limit or "none"), ", ".join(map(str, kills)), facts["hits"] if limit else "-", f"{int(facts['peak']) / 2**20:.1f}",
        f"{float(facts['stalled_us']) / seconds / 1e4:.1f}" if facts.get("stalled_us") else "-",
        str(zoned["missed_deadlines"]) if zoned else f"killed after {seconds:.0f} s",
        str(len(loads)), ", ".join(f"{quantile(loads, q):.0f}" for q in (0.5, 0.99, 1)) if loads else "-",
        f"{right}, {wrong}, {before['images'] + before['skipped']}",
        *(spread_text(zoneloc[key], before[key]) if zoneloc else "-" for key in ("query_ms", "latency_ms")),
        f"{beside:.0f} ({beside / rate(tenant):.2f})" if limit else "-")) + " |", flush=True)


if __name__ == "__main__":
    main()
