#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: memory_and_fixes.py BIN SOURCE DATA OUT [--budgets N] [--speed S]: what memory buys, from the smallest budget to
the whole map, as a Markdown table and a picture (OUT/memory_and_fixes.md and .svg), RTAB-Map's recorded runs beside.

BIN holds zonepack, zoned and zoneloc of a release build; DATA holds hospital.db, hospital-small.db, zones.geojson,
rtabmap_baseline and the missions scenario1_loop and scenario2_roundtrip. Fixes are those of `zoneloc replay` from a known
start. Memory is that of `zoned run` and `zoneloc run` on the same mission at S times its speed: of zoned the most that was
ever resident, of zoneloc its own (looked at 20 times a second), for what it maps of zoned's is zoned's. Alpha is that
memory over the map's bytes: once as stored in packs, once as the database that RTAB-Map has.
"""
import argparse
import csv
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from memory_picture import draw

MAPS = ("hospital", "hospital-small")
MISSIONS = ("scenario1_loop", "scenario2_roundtrip")


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}: {done.stderr[-2000:]}")
    return done.stdout


def pack(options, name, work):
    """The packed map, its bytes, and budgets from the smallest to the whole, each so much larger than the one before."""
    folder = work / name
    run(options.bin / "zonepack", "build", "--db", options.data / f"{name}.db", "--zones", options.data / "zones.geojson",
        "--out", folder, "--payload", "features,scan,grid")
    plan = json.loads(run(options.bin / "zonepack", "plan", folder, "--json", "-"))
    least = plan["smallest_budget_bytes"]
    slots = sum(zone["charged_bytes"] for zone in plan["zones"]) // plan["slot_bytes"]
    whole = plan["fixed_bytes"] + slots * (plan["slot_bytes"] + plan["table_bytes_per_slot"])
    steps = options.budgets - 1
    budgets = [round(least * (whole / least) ** (step / steps)) for step in range(steps + 1)]
    return folder, sum(path.stat().st_size for path in folder.rglob("*") if path.is_file()), budgets


def replay(options, folder, mission, budget):
    drive = options.data / mission
    return json.loads(run(options.bin / "zoneloc", "replay", "--config", options.source / "config/agilex.yaml", "--map", folder,
                          "--can", drive / "can0.log", "--images", drive / "rgb.txt", "--calibration",
                          drive / "calibration.yaml", "--truth", drive / "base_groundtruth.txt", "--start", "truth",
                          "--budget", budget, "--json", "-"))


def own_bytes(pid):
    """Of a process that maps zoned's memory: heap, stacks, program, libraries. Nothing once it has ended."""
    try:
        lines = Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return 0
    return sum(int(line.split()[1]) * 1024 for line in lines if line.startswith(("RssAnon", "RssFile")))


def start_of(drive):
    """Where a mission begins, as --start takes it."""
    rows = (line.split() for line in (drive / "base_groundtruth.txt").read_text(encoding="ascii").splitlines())
    pose = [float(word) for word in next(row for row in rows if row and not row[0].startswith("#"))]
    return f"{pose[1]},{pose[2]},{math.degrees(2 * math.atan2(pose[6], pose[7])):.4f}"


def resident(options, folder, mission, budget, work):
    """Bytes of zoned and of zoneloc at most, while both run live."""
    drive, summary = options.data / mission, work / "zoned.json"
    environment = {**os.environ, "ZONED_SOCKET": str(work / "zoned.sock"), "STATE_DIRECTORY": str(work)}
    quiet = {"env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    zoned = subprocess.Popen([options.bin / "zoned", "run", "--config", options.source / "config/agilex.yaml", "--map", folder,
                              "--budget", str(budget), "--start", start_of(drive), "--can",
                              f"log:{drive / 'can0.log'}@{options.speed}", "--quiet", "--json", summary], **quiet)
    while not (work / "zoned.sock").exists() and zoned.poll() is None:
        time.sleep(0.01)
    zoneloc = subprocess.Popen([options.bin / "zoneloc", "run", "--calibration", drive / "calibration.yaml", "--camera",
                                f"folder:{drive}@{options.speed}"], **quiet)
    most = 0
    while zoned.poll() is None:
        most = max(most, own_bytes(zoneloc.pid))
        time.sleep(0.05)
    zoneloc.terminate()
    zoneloc.wait()
    if zoned.returncode != 0:
        sys.exit(f"zoned run, {mission}: exit code {zoned.returncode}: {zoned.stderr.read().decode()}")
    return json.loads(summary.read_text(encoding="utf-8"))["process_peak_bytes"], most


def ours(options, work):
    """A dictionary for each map, mission and budget."""
    for name in MAPS:
        folder, packed, budgets = pack(options, name, work)
        database = (options.data / f"{name}.db").stat().st_size
        for mission in MISSIONS:
            for budget in budgets:
                print(f"{name}, {mission}, {budget / 2**20:.2f} MiB", file=sys.stderr)
                fixes = replay(options, folder, mission, budget)
                zoned, zoneloc = resident(options, folder, mission, budget, work)
                yield {"map": name, "mission": mission, "budget": budget, "zoned": zoned, "zoneloc": zoneloc,
                       "packed": packed, "database": database, "bytes": zoned + zoneloc, "wrong": fixes["wrong"],
                       "share": fixes["right"] / fixes["images"], "absent_s": fixes["zone_absent_s"]}


def rtabmap(options):
    """The same of each recorded run of RTAB-Map. Its memory is what it counted itself, of the whole process."""
    for path in sorted((options.data / "rtabmap_baseline").glob("*_scenario*.csv")):
        short, scenario, _, limit, retrieved, known = path.stem.split("_")
        name = "hospital" if short == "hospital" else "hospital-small"
        with path.open(encoding="ascii") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        right = wrong = 0
        for row in rows:
            x, y, yaw, mx, my, myaw = (float(row[key]) for key in ("gx", "gy", "gyaw", "mx", "my", "myaw"))
            if float(row["accepted"]) == 0:
                continue
            off = abs(math.remainder(yaw - myaw, 2 * math.pi))
            near = math.hypot(x - mx, y - my) <= 0.5 and off <= math.radians(10)
            right, wrong = right + near, wrong + (not near)
        yield {"map": name, "mission": next(m for m in MISSIONS if m.startswith(scenario)),
               "settings": f"{limit.replace('thr', 'MemoryThr ')}, {retrieved.replace('ret', 'MaxRetrieved ')}"
                           + ("" if known == "inittrue" else ", started empty"),
               "database": (options.data / f"{name}.db").stat().st_size, "share": right / len(rows), "wrong": wrong,
               "bytes": max(float(row["ram_mb"]) for row in rows) * 2**20}


def table(measured, recorded):
    lines = ["| map | drive | budget, MiB | resident: zoned + zoneloc, MiB | times the packs: zoned, both | times the database |"
             " right fixes, % | wrong | own zone missing, s |", "|---" * 9 + "|"]
    for row in measured:
        sizes = " + ".join(f"{row[program] / 2**20:.1f}" for program in ("zoned", "zoneloc"))
        alphas = ", ".join(f"{row[memory] / row['packed']:.2f}" for memory in ("zoned", "bytes"))
        lines.append(line(row, f"{row['budget'] / 2**20:.2f}", sizes, alphas, f"{row['absent_s']:.1f}"))
    for row in recorded:
        lines.append(line(row, f"RTAB-Map, {row['settings']}", f"{row['bytes'] / 2**20:.0f}", "-", "-"))
    return "\n".join(lines) + "\n"


def line(row, budget, sizes, alphas, absent):
    cells = (row["map"], row["mission"].split("_")[1], budget, sizes, alphas, f"{row['bytes'] / row['database']:.2f}",
             f"{row['share'] * 100:.1f}", row["wrong"], absent)
    return "| " + " | ".join(map(str, cells)) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("bin", "source", "data", "out"):
        parser.add_argument(name, type=lambda text: Path(text).resolve())
    parser.add_argument("--budgets", type=int, default=6)
    parser.add_argument("--speed", type=float, default=8)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR", "/var/tmp")) as folder:
        measured = list(ours(options, Path(folder)))
    recorded = list(rtabmap(options))
    text = table(measured, recorded)
    (options.out / "memory_and_fixes.md").write_text(text, encoding="utf-8")
    (options.out / "memory_and_fixes.svg").write_text(draw(measured, recorded), encoding="utf-8")
    print(text, end="")


if __name__ == "__main__":
    main()
