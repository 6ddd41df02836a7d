#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: drive_test.py BIN SOURCE: a robot drives through maps of every kind, replayed and live, at plan's smallest budget.

Packed with the same zones, each map takes it along the same way, never over its budget and never without its own zone.
"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from source_tools import BIN, DATABASE, SOURCE, build, need, zonepack

sys.path.insert(0, str(SOURCE / "tests/support"))
import hospital_cloud as clouds  # noqa: E402
import stella_map  # noqa: E402

DRIVE = SOURCE / "tests/data/scenario1_loop"
LIVE = ("map.msg", "cloud.pcd")
SPEED = 100  # of the log, played to the live robot


def sources(work):
    """Of each kind: its file, and the options that place it."""
    signatures, camera = stella_map.read_rtabmap(DATABASE, 10**9)
    made = stella_map.StellaMap(signatures, camera, 1.0, "RGBD")
    made.write_msgpack(work / "map.msg", False)
    made.write_sqlite(work / "map.db")
    with open(work / "base.txt", "w", encoding="ascii") as out:
        for stamp, p, q in made.trajectory:
            out.write(f"{stamp:.9f} " + " ".join(f"{value:.9f}" for value in p + q) + "\n")
    placed = ("--align", work / "base.txt", "--camera-in-base", "0.2,0,0.5,0,0,0")
    submaps = list(clouds.submaps_of(DATABASE))
    points = [tuple(clouds.single(v) for v in clouds.place(T, p[:3])) + p[3:] for _, _, T, own in submaps for p in own]
    clouds.write_pcd(work / "cloud.pcd", points, "binary")
    clouds.write_autoware(work / "autoware", points, 20)
    clouds.write_glim(work / "glim", submaps)
    return {"map.msg": placed, "map.db": placed, "cloud.pcd": (), "autoware": (), "glim": ()}


def zoned(work, *arguments):
    privilege = subprocess.run(["chrt", "-f", "1", "true"], capture_output=True, check=False).returncode == 0
    degraded = () if privilege or arguments[0] != "run" else ("--allow-degraded",)
    done = subprocess.run([str(word) for word in (BIN / "zoned", *arguments, *degraded, "--json", work / "run.json")],
                          capture_output=True, text=True, check=False, timeout=300,
                          env={**os.environ, "ZONED_SOCKET": str(work / "zoned.sock")})
    need(done.returncode == 0, f"zoned {arguments}: {done.stderr}")
    return json.loads((work / "run.json").read_text())


def way_of(path):
    events = map(json.loads, path.read_text().splitlines())
    return [(e["cycle"], e["zone"]) for e in events if e["event"] == "zone_entered"]


def drive(work, name, form, log):
    budget = json.loads(zonepack("plan", work / f"packed-{name}", "--json", "-").stdout)["smallest_budget_bytes"]
    run = zoned(work, form, "--config", SOURCE / "config/agilex.yaml", "--map", work / f"packed-{name}", "--can", log,
                "--corrections", DRIVE / "corrections.txt", "--budget", budget, "--events", work / f"{name}-{form}.jsonl")
    need(run["budget_violations"] == 0 and run["peak_charged_bytes"] <= budget, f"{name}, {form}: over the budget: {run}")
    need(run["zones_loaded"] > 1, f"{name}, {form}: loads {run['zones_loaded']} zones, which shows nothing")
    # A live robot that drives so much faster than its clock is a while in a zone that is still being read.
    need(form == "run" or run["zone_absent_s"] == 0, f"{name}, {form}: {run['zone_absent_s']} s without its zone")
    print(f"{name}, {form}: {run['zones_loaded']} zones loaded under {budget} bytes")
    return way_of(work / f"{name}-{form}.jsonl")


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        ways = {}
        for name, options in sources(work).items():
            build(work / name, work / f"packed-{name}", *options)
            ways[name] = drive(work, name, "replay", DRIVE / "can0.log")
            if name in LIVE:
                ways[f"{name}, live"] = drive(work, name, "run", f"log:{DRIVE / 'can0.log'}@{SPEED}")
        first = ways["map.msg"]
        need(len(first) > 3, f"a short way: {first}")
        for name, way in ways.items():
            need(way == first, f"{name}: another way than through map.msg: {way}")
    print("drive_test: the same drive through maps of every kind, within the smallest budget")


if __name__ == "__main__":
    main()
