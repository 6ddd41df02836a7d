#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: evaluate_test.py BIN SOURCE: zoned evaluate on the sample map and scenario 1. What it counts is what zoned
replay counts; every policy chooses what plain code of its paper chooses; bounds hold; the number of threads changes
nothing; a recording is as good as a log; bad input is refused by name.
"""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from reference_policies import POLICIES, check

BIN, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
DATA = SOURCE / "tests/data"
DRIVE = DATA / "scenario1_loop"
CONFIG = SOURCE / "config/agilex.yaml"
LOG = ("--can", DRIVE / "can0.log", "--corrections", DRIVE / "corrections.txt",
       "--truth", DRIVE / "base_groundtruth.txt")
KEYS = {"map", "drive", "budget_bytes", "max_signatures", "eviction", "preload", "storage_rate", "loads", "unloads",
        "zones", "signatures_loaded", "bytes_read", "bytes_read_unused", "zone_absent_s", "blocked_s", "prediction",
        "bounds"}


def need(holds, what):
    if not holds:
        sys.exit(f"evaluate_test: {what}")


def run(*command, code=0):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, timeout=300)
    need(done.returncode == code, f"{' '.join(map(str, command))}: exit code {done.returncode}, not {code}: "
         f"{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done


def evaluate(*options, code=0):
    return run(BIN / "zoned", "evaluate", "--config", CONFIG, *options, code=code)


def runs_of(*options):
    return json.loads(evaluate(*options, "--json", "-").stdout)["runs"]


def counts_as_replay_does():
    """At the paper's limit: 82 signatures of five zones, none unloaded."""
    one, = runs_of("--map", "map", *LOG, "--max-signatures", "100")
    need(KEYS <= one.keys(), f"keys {KEYS - one.keys()} are missing")
    replayed = json.loads(run(BIN / "zoned", "replay", "--config", CONFIG, "--map", "map", *LOG, "--max-signatures",
                              "100", "--json", "-").stdout)
    need(one["signatures_loaded"] == 82 and one["unloads"] == 0, f"scenario 1 loads {one}")
    for ours, theirs in (("event_log_hash",) * 2, ("loads", "zones_loaded"), ("budget_bytes",) * 2,
                         ("zone_absent_s",) * 2, ("bytes_read", "bytes_loaded")):
        need(one[ours] == replayed[theirs], f"{ours} is {one[ours]}, and {replayed[theirs]} in replay")
    # L1 H1 C2 H2 C3 L1: five changes, each foreseen by the way that the robot went.
    need(one["zones"] == 6 and one["prediction"]["first_two"] == 1, f"foresees {one['prediction']}")
    need(one["requests"] - one["hits"] == one["loads"], "a request is a hit or a load, with this much room")


def chooses_as_the_papers_say():
    """In 50 signatures, where zones come back after they were evicted, and in less than the day shift would like."""
    names = ",".join(POLICIES)
    runs = runs_of("--map", "map", *LOG, "--max-signatures", "49,60", "--eviction", names, "--preload", "none,portal",
                   "--trace-csv", "traces")
    need(len(runs) == 2 * 2 * len(POLICIES), f"{len(runs)} runs")
    evictions = 0
    for one in runs:
        counted = check(one["eviction"], Path("traces") / one["trace"])
        told = one["requests"], one["hits"], one["unloads"]
        need(counted == told, f"{one['trace']}: {one['eviction']} counts {told}, other code {counted}")
        evictions += counted[2]
        loads, bounds = one["loads"], one["bounds"]
        need(bounds["lower"]["loads"] <= min(loads, bounds["farthest"]["loads"]), f"the bound {bounds} of {loads}")
        need(bounds["lower"]["signatures"] <= one["signatures_loaded"], f"the bound {bounds} of {one}")
        need(bounds["lower"]["bytes"] <= one["bytes_read"], f"the bound {bounds} of {one}")
        need(one["budget_violations"] == 0, f"{one} is over a limit")
        need((one["prediction"]["first"] is None) == (one["preload"] == "none"), f"foresees {one}")
    need(evictions > 40, f"only {evictions} evictions")
    # The check can fail: a trace of one policy is not another's.
    lru = next(one for one in runs if one["eviction"] == "lru" and one["unloads"] > 2)
    with open(Path("traces") / lru["trace"], newline="") as file:
        rows = list(csv.reader(file))
    first = next(i for i, row in enumerate(rows) if row[1] == "evicted")
    held = {row[2] for row in rows[:first] if row[1] == "loaded"} - {rows[first][2]}
    rows[first][2] = sorted(held)[0]
    with open("forged.csv", "w", newline="") as file:
        csv.writer(file).writerows(rows)
    try:
        check("lru", "forged.csv")
        need(False, "a forged trace passes")
    except AssertionError:
        pass


def forecasts_as_the_robot_does():
    """memory.eviction and preload.learn of the settings are --eviction expected and --preload transitions; who knows the
    way evicts no zone that comes soon."""
    settings = (SOURCE / "config/agilex.yaml").read_text()
    Path("agilex.dbc").write_bytes((SOURCE / "config/agilex.dbc").read_bytes())
    settings, once = re.subn(r"^  eviction: lru", "  eviction: expected", settings, flags=re.MULTILINE)
    settings, again = re.subn(r"^  learn: false", "  learn: true", settings, flags=re.MULTILINE)
    need(once == 1 and again == 1, "agilex.yaml has no eviction and learn")
    Path("habits.yaml").write_text(settings)
    limit = ("--max-signatures", "60")
    replayed = json.loads(run(BIN / "zoned", "replay", "--config", "habits.yaml", "--map", "map", *LOG, *limit,
                              "--json", "-").stdout)
    runs = runs_of("--map", "map", *LOG, *limit, "--eviction", "lru,expected", "--preload", "transitions,route")
    same = [one for one in runs if one["event_log_hash"] == replayed["event_log_hash"]]
    need([(one["eviction"], one["preload"]) for one in same] == [("expected", "transitions")],
         f"the robot's run is that of {same}")
    by_default, = json.loads(run(BIN / "zoned", "evaluate", "--config", "habits.yaml", "--map", "map", *LOG, *limit,
                                 "--json", "-").stdout)["runs"]
    need(by_default == same[0], f"by the settings: {by_default}")
    for one in runs:
        need(one["budget_violations"] == 0 and one["zone_absent_s"] == 0, f"{one}")
    known = {one["eviction"]: one["signatures_loaded"] for one in runs if one["preload"] == "route"}
    need(known["expected"] <= known["lru"], f"with the way known, {known}")


def many_threads_give_the_same():
    options = ("--map", "map", "--map", "map", *LOG, "--budgets", "auto", "--eviction", "lru,sieve")
    one = evaluate(*options, "--jobs", "1", "--json", "one.json", "--report", "one.html")
    two = evaluate(*options, "--jobs", "5", "--json", "two.json", "--report", "two.html")
    need(one.stdout == two.stdout and one.stdout.count("\n") == 33, f"the table: {one.stdout}")
    for kind in ("json", "html"):
        need(Path(f"one.{kind}").read_bytes() == Path(f"two.{kind}").read_bytes(), f"one.{kind} is not two.{kind}")
    budgets = [run["budget_bytes"] for run in json.loads(Path("one.json").read_text())["runs"]][:16:2]
    plan = json.loads(run(BIN / "zonepack", "plan", "map", "--json", "-").stdout)
    slot = plan["slot_bytes"] + plan["table_bytes_per_slot"]
    whole = plan["fixed_bytes"] + sum(zone["slots"] for zone in plan["zones"]) * slot
    need(budgets == sorted(set(budgets)) and budgets[0] == plan["smallest_budget_bytes"], f"budgets {budgets}")
    need(whole - slot < budgets[-1] <= whole, f"the last of {budgets} is not the whole map, {whole}")
    page = Path("one.html").read_text()
    for word in ("Signatures retrieved", "Signatures removed", "Signatures in working memory",
                 "Signatures loaded over the budget", "Totals"):
        need(word in page, f"the report has no '{word}'")
    need(re.search(r"^evaluating: 32 runs in .* s$", one.stderr, re.MULTILINE), f"progress: {one.stderr}")


def a_recording_is_as_good_as_a_log():
    lines = (DRIVE / "can0.log").read_text().splitlines(True)[:6000]  # 30 s
    Path("short.log").write_text("".join(lines))
    run(BIN / "zoned", "run", "--config", CONFIG, "--map", "map", "--can", "log:short.log@30", "--corrections",
        DRIVE / "corrections.txt", "--record", "run.zpr", "--allow-degraded", "--socket", "", "--quiet")
    both = runs_of("--map", "map", "--can", "short.log", "--corrections", DRIVE / "corrections.txt", "--recording",
                   "run.zpr", "--max-signatures", "100")
    need([one["drive"] for one in both] == ["short.log", "run.zpr"], f"drives of {both}")
    for key in ("zones", "loads", "signatures_loaded", "zone_absent_s"):
        need(both[0][key] == both[1][key], f"{key} is {both[1][key]} from the recording, and {both[0][key]}")


def bad_input_is_refused_by_name():
    fixes = ("--corrections", DRIVE / "corrections.txt")
    for code, options, word in (
            (2, ("--map", "map"), "--can LOG or --recording FILE"),
            (2, ("--map", "map", "--can", DRIVE / "can0.log"), "--corrections FILE after --can"),
            (2, ("--map", "map", *fixes), "belongs to the --can before it"),
            (2, ("--map", "map", *LOG, *fixes), "given twice"),
            (2, ("--map", "map", "--recording", "run.zpr", *fixes), "holds its own"),
            (2, ("--map", "map", *LOG, "--eviction", "lru,sive"), 'did you mean "sieve"'),
            (2, ("--map", "map", *LOG, "--preload", "all"), "none, portal"),
            (2, ("--map", "map", *LOG, "--budgets", "8MiB,much"), "SIZE"),
            (2, ("--map", "map", *LOG, "--budgets", "8MiB,"), "SIZE"),
            (2, ("--map", "map", *LOG, "--max-signatures", "-1"), "--max-signatures"),
            (2, ("--map", "map", *LOG, "--storage-rate", "1"), "--storage-rate"),
            (2, ("--map", "map", *LOG, "--jobs", "0"), "--jobs"),
            (2, ("--map", "map", *LOG, "--report", "page.pdf"), ".html"),
            (1, ("--map", "nowhere", *LOG), "nowhere"),
            (1, ("--map", "map", *LOG, "--budgets", "8MiB,400KiB"), "smallest budget"),
            (1, ("--map", "map", *LOG, "--max-signatures", "20"), "L1"),
            (1, ("--map", "map", "--can", "no.log", *fixes), "no.log"),
            (1, ("--map", "map", "--can", "empty.log", *fixes), "empty.log"),
            (1, ("--map", "map", "--can", DRIVE / "can0.log", "--corrections", "no.txt"), "no.txt"),
            (1, ("--map", "map", *LOG[:4], "--truth", "no.txt"), "no.txt"),
            (1, ("--map", "map", "--recording", "no.zpr"), "no.zpr"),
            (1, ("--map", "map", "--recording", "empty.log"), "empty.log"),
            (1, ("--map", "map", *LOG, "--json", "no/folder.json"), "no/folder.json"),
            (1, ("--map", "map", *LOG, "--trace-csv", "empty.log"), "empty.log")):
        done = evaluate(*options, code=code)
        need(word in done.stderr, f"{options}: no word of '{word}' in: {done.stderr}")


with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    Path("empty.log").touch()
    run(BIN / "zonepack", "build", "--db", DATA / "hospital-small.db", "--zones", DATA / "zones.geojson", "--out",
        "map", "--payload", "features,scan,grid")
    counts_as_replay_does()
    chooses_as_the_papers_say()
    forecasts_as_the_robot_does()
    many_threads_give_the_same()
    a_recording_is_as_good_as_a_log()
    bad_input_is_refused_by_name()
