#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: growth.py BIN SOURCE DATA [--hours H] [--laps N] [--speed S]: does anything grow? As a Markdown table.

First zoned alone, by its own threads: the day shift driven for H hours (24) of the robot's time, as fast as it goes. Then
zoned and zoneloc together: the loop with its images, N laps (10) at S times its speed (4). A lap does not end where it
began, so the robot is set down elsewhere for the next; fixes of the mission tell zoned. Each at the map's smallest budget.
Told are the first and the last hour, or lap, and the whole: the most memory that was resident, of zoneloc its own, and
the zones loaded and unloaded meanwhile. system/prove/soak.sh judges the same of descriptors, threads and files.
BIN holds zonepack, zoned and zoneloc of a release build, DATA hospital.db, zones.geojson, dayshift and scenario1_loop.
"""
import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

LOOK_S = 0.1


def repeat(options, mission, loops, path):
    """PATH.yaml and PATH.txt, a mission without a pause between its loops; seconds of one."""
    lib = options.source / "tests/system/prove/lib.sh"
    done = subprocess.run(["bash", "-c", '. "$1"; repeat_mission "$2" "$3" "$4"; log_seconds "$2"', "-", lib, mission,
                           str(loops), path], capture_output=True, text=True, check=True)
    return float(done.stdout) + 0.02


def resident(pid):
    """Bytes now: all, and without what is shared with zoned. Nothing once the process has ended."""
    try:
        status = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except OSError:
        return None
    kib = {line.split(":")[0]: int(line.split()[1]) for line in status.splitlines() if line.startswith("Rss")}
    return (sum(kib.values()) * 1024, (kib["RssAnon"] + kib["RssFile"]) * 1024) if kib else None


class Run:
    """zoned on a repeated mission, and zoneloc where there are images."""

    def __init__(self, options, folder, work):
        self.options, self.folder, self.work = options, folder, work
        self.looks = {"zoned": [], "zoneloc": []}
        self.environment = {**os.environ, "ZONED_SOCKET": str(work / "zoned.sock"), "STATE_DIRECTORY": str(work)}

    def start(self, program, *arguments):
        with (self.work / f"{program}.txt").open("w", encoding="utf-8") as log:
            return subprocess.Popen([self.options.bin / program, *map(str, arguments)], env=self.environment, stdout=log,
                                    stderr=subprocess.STDOUT)

    def drive(self, drive, speed, localizer=()):
        """Until the drive ends, looking at memory meanwhile; returns the seconds that it took."""
        started = time.monotonic()
        zoned = self.start("zoned", "run", "--config", self.options.source / "config/agilex.yaml", "--map", self.folder,
                           "--can", f"sim:{drive}.yaml@{speed}", "--quiet", "--json", self.work / "run.json", "--events",
                           self.work / "events.jsonl", "--budget", self.budget(), "--corrections",
                           f"{drive}.txt")
        while not (self.work / "zoned.sock").exists() and zoned.poll() is None:
            time.sleep(0.01)
        zoneloc = self.start("zoneloc", "run", *localizer) if localizer else None
        while zoned.poll() is None:
            for name, process in (("zoned", zoned), ("zoneloc", zoneloc)):
                found = process and resident(process.pid)
                if found:
                    self.looks[name].append(found[name == "zoneloc"])
            time.sleep(LOOK_S)
        if zoneloc:
            zoneloc.send_signal(signal.SIGTERM)
            zoneloc.wait()
        if zoned.returncode != 0:
            sys.exit(f"zoned: exit code {zoned.returncode}: {(self.work / 'zoned.txt').read_text()[-2000:]}")
        return time.monotonic() - started

    def budget(self):
        done = subprocess.run([self.options.bin / "zonepack", "plan", self.folder, "--json", "-"], capture_output=True,
                              check=True)
        return json.loads(done.stdout)["smallest_budget_bytes"]

    def counts(self, parts):
        """Zones loaded and unloaded in the first of so many equal parts of the run, and in the last."""
        events = [json.loads(line) for line in (self.work / "events.jsonl").read_text(encoding="utf-8").splitlines()]
        end = events[-1]["t_ns"]
        part = end / parts
        return [tuple(sum(event["event"] == kind and begin <= event["t_ns"] < begin + part for event in events)
                      for kind in ("load_done", "evicted")) for begin in (0, end - part)]

    def rows(self, what, part, parts, seconds):
        counts = self.counts(parts)
        for name, looks in self.looks.items():
            looks = looks[:-2]  # the last may find a process that is ending
            if not looks:
                continue
            share = max(len(looks) // parts, 1)
            most = [f"{max(some) / 2**20:.2f}" for some in (looks[:share], looks[-share:], looks)]
            loads = [f"{loaded} / {unloaded}" for loaded, unloaded in counts]
            cells = (f"{name}, {what}", f"{part} 1 and {parts}", *most, *loads, f"{seconds:.0f}")
            print("| " + " | ".join(cells) + " |", flush=True)


def images_of(mission, laps, turn, folder):
    """A folder of images whose list is the mission's, lap after lap."""
    folder.mkdir()
    (folder / "rgb").symlink_to(mission / "rgb")
    rows = [line.split() for line in (mission / "rgb.txt").read_text(encoding="ascii").splitlines() if line[0] != "#"]
    with (folder / "rgb.txt").open("w", encoding="ascii") as out:
        for lap in range(laps):
            for stamp, name in rows:
                if lap == 0 or stamp != rows[0][0]:
                    out.write(f"{float(stamp) + lap * turn:.6f} {name}\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("bin", "source", "data"):
        parser.add_argument(name, type=lambda text: Path(text).resolve())
    parser.add_argument("--hours", type=int, default=24)
    parser.add_argument("--laps", type=int, default=10)
    parser.add_argument("--speed", type=float, default=4)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR", "/var/tmp")) as place:
        work = Path(place)
        subprocess.run([options.bin / "zonepack", "build", "--db", options.data / "hospital.db", "--zones",
                        options.data / "zones.geojson", "--out", work / "map", "--payload", "features,scan,grid"],
                       capture_output=True, check=True)
        print("| what | told | resident in the first, MiB | in the last | in all | zones loaded / unloaded in the first |"
              " in the last | took, s |")
        print("|---" * 8 + "|")
        day, loop = options.data / "dayshift", options.data / "scenario1_loop"
        for name in ("day", "loop"):
            (work / name).mkdir()
        turn = repeat(options, day, 1, work / "once")
        repeat(options, day, round(options.hours * 3600 / turn), work / "day/drive")
        run = Run(options, work / "map", work / "day")
        run.rows("day shift", "hours", options.hours, run.drive(work / "day/drive", 100000))
        turn = repeat(options, loop, options.laps, work / "loop/drive")
        images_of(loop, options.laps, turn, work / "loop/images")
        run = Run(options, work / "map", work / "loop")
        seconds = run.drive(work / "loop/drive", options.speed, ("--calibration", loop / "calibration.yaml", "--camera",
                            f"folder:{work / 'loop/images'}@{options.speed}", "--json", work / "loop/zoneloc.json"))
        run.rows("loop with a camera", "laps", options.laps, seconds)
        told = json.loads((work / "loop/zoneloc.json").read_text(encoding="utf-8"))
        print(f"zoneloc: {told['accepted']} fixes of {told['images']} images, {told['skipped']} skipped", file=sys.stderr)


if __name__ == "__main__":
    main()
