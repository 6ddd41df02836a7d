#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: lost_test.py BIN SOURCE: zoneloc replay of the sample drive by a robot that is lost from the start, one that
is said to be elsewhere, and one that is lost in a map without its place.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
DRIVE = SOURCE / "tests/data/scenario1_loop"


def need(holds, what):
    if not holds:
        sys.exit(f"lost_test: {what}")


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, timeout=600)
    need(done.returncode == 0, f"{' '.join(map(str, command))}: exit code {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def replay(folder, start, images=DRIVE / "rgb.txt"):
    said = run(BIN / "zoneloc", "replay", "--config", SOURCE / "config/agilex.yaml", "--map", folder / "map", "--can",
               DRIVE / "can0.log", "--images", images, "--calibration", DRIVE / "calibration.yaml", "--truth",
               DRIVE / "base_groundtruth.txt", f"--start={start}", "--fixes", folder / "fixes.txt", "--events",
               folder / "events.jsonl", "--json", folder / "loop.json")
    (folder / "said.txt").write_text(said)
    events = [json.loads(line) for line in (folder / "events.jsonl").read_text().splitlines()]
    return json.loads((folder / "loop.json").read_text()), events


def hash_of_fixes(folder, *more):
    """The events that zoned decides on with what the localizer wrote."""
    run(BIN / "zoned", "replay", "--config", SOURCE / "config/agilex.yaml", "--map", folder / "map", "--can",
        DRIVE / "can0.log", "--corrections", folder / "fixes.txt", "--json", folder / "zoned.json", *more)
    return json.loads((folder / "zoned.json").read_text())["event_log_hash"]


def words(events):
    return [event["event"] for event in events]


def check_found(figures, events, lost_first):
    need(figures["wrong"] == 0 and figures["right"] > 0, f"expected right fixes only: {figures}")
    need(figures["budget_violations"] == 0, f"expected the budget to be held: {figures}")
    need(figures["peak_charged_bytes"] <= figures["budget_bytes"], f"expected the budget to be held: {figures}")
    need(figures["times_lost"] == 1, f"expected the robot to be lost once: {figures}")
    need(figures["found_after_s"] is not None, f"expected the robot to be found: {figures}")
    names = words(events)
    lost, found = names.index("pose_lost"), names.index("pose_found")
    need("zone_sought" in names[lost:found], "no zone is sought between pose_lost and pose_found")
    need("pose_trusted" not in names[:lost], "the pose is trusted before it is lost")
    if lost_first:
        need("zone_entered" not in names[:lost], "a zone is entered by a robot without pose")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(BIN / "zonepack", "build", "--db", SOURCE / "tests/data/hospital-small.db", "--zones",
            SOURCE / "tests/data/zones.geojson", "--out", folder / "map", "--payload", "features")
        figures, events = replay(folder, "lost")
        check_found(figures, events, True)
        need(hash_of_fixes(folder) == figures["event_log_hash"], "zoned decides otherwise on what zoneloc wrote")
        fixes = (folder / "fixes.txt").read_text()
        (folder / "fixes.txt").write_text("".join(line + "\n" for line in fixes.splitlines()
                                                  if not line.startswith("# command")))
        need(hash_of_fixes(folder) != figures["event_log_hash"], "the commands in the file make no difference")

        figures, events = replay(folder, "3,-20,90")
        check_found(figures, events, False)
        need(hash_of_fixes(folder, "--start=3,-20,90") == figures["event_log_hash"],
             "zoned decides otherwise on what zoneloc wrote for a wrong start")

        # One image for 20 s of the drive, from a camera that hangs: taken once, never confirmed, and a turn is asked for.
        rows = [line.split() for line in (DRIVE / "rgb.txt").read_text().splitlines()
                if line and not line.startswith("#")]
        (folder / "one.txt").write_text("".join(f"{row[0]} {DRIVE / rows[0][1]}\n" for row in rows[:40]))
        figures, events = replay(folder, "lost", folder / "one.txt")
        need(figures["accepted"] == 0 and figures["found_after_s"] is None, f"one image tells no place: {figures}")
        need("turn_asked" in words(events), "no turn is asked for")
        need("bit for bit" in (folder / "said.txt").read_text(), "the camera that hangs is not named")
    print("a lost robot is found in the sample map, within the budget, and zoned decides the same again")


main()
