#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: misfits_test.py BIN SOURCE: files that are right and do not fit each other. A log of other frames than the
settings read, truth and fixes of another day, a clock that is set by decades, a database that holds no signatures or
changes while it is read, what is no such file at all, settings without a budget: what each program says, and how
it ends.
"""
import gzip
import json
import os
import re
import sqlite3
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
DATA, CONFIG = SOURCE / "tests/data", SOURCE / "config/agilex.yaml"
DRIVE = DATA / "scenario1_loop"
LOG, TRUTH, FIXES = DRIVE / "can0.log", DRIVE / "base_groundtruth.txt", DRIVE / "corrections.txt"
PLAYED = ("--allow-degraded", "--config", CONFIG, "--map", "map", "--socket", "socket")
BUILDS = 8


def need(holds, what):
    if not holds:
        sys.exit(f"misfits_test: {what}")


def run(program, *arguments, code=0):
    command = [str(part) for part in (BIN / program, *arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    need(code is None or done.returncode == code,
         f"{' '.join(command)}: exit code {done.returncode}, not {code}: {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def says(text, words):
    need(words in text, f"does not say '{words}': {text}")


def other_frames():
    """The drive's log, all of whose frames have an identifier that the settings do not read."""
    log = Path("other.log")
    log.write_text(re.sub(r" can0 \w+#", " can0 7FF#", LOG.read_text()))
    mismatch = ("other.log: holds none of the frames that odometry reads: expected 0x311 (11 bits); the log has 0x7FF "
                "(11 bits) 11046 times")
    told = run("zoned", "replay", "--config", CONFIG, "--map", "map", "--can", log, "--report", "other.html")
    says(told, mismatch)
    says(told, "NEVER LOCALISED")
    page = Path("other.html").read_text()
    says(page, "but the robot was never localised: its own zone was never in memory")
    says(page, "no truth, so nothing is known of wrong zones")
    says(run("zoned", "run", "--check", *PLAYED, "--can", f"log:{log}"), mismatch)
    says(run("zoned", "run", "--quiet", *PLAYED, "--can", f"log:{log}@1000"), "no odometry since the start")


def another_day():
    """Truth and fixes that are 11 days later than the log: nothing of them can be used."""
    def later(path, stamps):
        lines = [line.split() for line in path.read_text().splitlines() if not line.startswith("#")]
        for line in lines:
            line[:stamps] = [f"{float(stamp) + 1e6:.6f}" for stamp in line[:stamps]]
        out = Path(f"later_{path.name}")
        out.write_text("\n".join(" ".join(line) for line in lines) + "\n")
        return out

    common = ("replay", "--config", CONFIG, "--map", "map", "--can", LOG)
    for arguments in (("--corrections", later(FIXES, 2)), ("--corrections", FIXES, "--truth", later(TRUTH, 1))):
        told = run("zoned", *common, *arguments, code=1)
        says(told, f"{arguments[-1]}: covers 1719021600.000 to ")
        says(told, "1718021600.001 to 1718021710.441 s: nothing of it could be used")
    told = run("zoned", "calibrate", "--config", CONFIG, "--can", LOG, "--truth", later(TRUTH, 1), code=1)
    says(told, "covers 1719021600.000 to ")
    says(told, "nothing of it could be used")


def clock_set():
    """A log whose clock is set by decades half way: said once, and a calibration and a recording go on across it."""
    lines = LOG.read_text().splitlines()
    half = len(lines) // 2

    def set_by(line, seconds):
        stamp, rest = line.split(") ", 1)
        return f"({float(stamp[1:]) + seconds:.6f}) {rest}"

    for name, seconds, words in (("ahead.log", 1e9, "31.7 years later"), ("back.log", -1e9, "31.7 years earlier")):
        Path(name).write_text("\n".join(lines[:half] + [set_by(line, seconds) for line in lines[half:]]) + "\n")
        said = f"{name}:{half + 1}: the clock of the log was set from "
        told = run("zoned", "calibrate", "--config", CONFIG, "--can", name, "--truth", TRUTH)
        need(told.count(said) == 1 and words in told, f"does not say once that the clock was set: {told}")
        need(re.search(r"error at the end +1\.088 ", told), f"calibrates otherwise than without the jump: {told}")
        told = run("zoned", "run", *PLAYED, "--can", f"log:{name}@200", "--record", f"{name}.zpr")
        need(told.count(said) == 1, f"the run does not say once that the clock was set: {told}")
        run("zoned", "replay", "--recording", f"{name}.zpr")


def no_signatures():
    path = Path("empty.db")
    path.write_bytes((DATA / "hospital-small.db").read_bytes())
    with sqlite3.connect(path) as database:
        for table in ("Node", "Link", "Data", "Feature"):
            database.execute(f"DELETE FROM {table}")
    zones = DATA / "zones.geojson"
    for command in (("build", "--zones", zones, "--out", "none"), ("outline", "--out", "none"),
                    ("suggest-zones", "--out", "none.geojson"), ("check-zones", zones)):
        told = run("zonepack", command[0], *command[1:], "--db", path, code=1)
        says(told, "empty.db: the database holds no signatures")
    need(not Path("none").exists() and not Path("none.geojson").exists(), "something was written of no signatures")


def written_meanwhile():
    """A build beside one that commits all the time has one state or refuses, and calls nothing damaged."""
    path = Path("busy.db")
    path.write_bytes((DATA / "hospital-small.db").read_bytes())
    ending, commits = threading.Event(), []

    def write():
        with sqlite3.connect(path, timeout=60) as database:
            while not ending.is_set():
                database.execute("UPDATE Node SET time_enter = time_enter + 1")
                database.commit()
                commits.append(1)

    writer = threading.Thread(target=write)
    writer.start()
    try:
        for i in range(BUILDS):
            told = run("zonepack", "build", "--db", path, "--zones", DATA / "zones.geojson", "--out", f"busy{i}",
                       code=None)
            need("damaged" not in told, f"a database that another writes is called damaged: {told}")
            if Path(f"busy{i}/manifest.zpm").exists():
                run("zonepack", "verify", f"busy{i}")
            else:
                says(told, "busy.db")
    finally:
        ending.set()
        writer.join()
    need(len(commits) >= BUILDS, f"only {len(commits)} commits beside {BUILDS} builds")
    done = sum(Path(f"busy{i}/manifest.zpm").exists() for i in range(BUILDS))
    print(f"   {len(commits)} commits beside {BUILDS} builds, {done} of them done")


def not_the_file_itself():
    """A Git LFS pointer and a gzip are called what they are by everything that reads a file, with what to type."""
    Path("pointer").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:" + "4d" * 32 + "\nsize 12345\n")
    Path("packed").write_bytes(gzip.compress((DATA / "zones.geojson").read_bytes()))
    zones, database = DATA / "zones.geojson", DATA / "hospital-small.db"
    for name, words in (("pointer", "pointer: is a Git LFS pointer, not the file itself; run: git lfs pull"),
                        ("packed", "packed: is compressed by gzip; run gunzip first: gunzip < 'packed' > NEW")):
        for command in (("zonepack", "check-zones", name, "--db", database),
                        ("zonepack", "build", "--db", name, "--zones", zones, "--out", "none"),
                        ("zonepack", "outline", "--db", name, "--out", "none"),
                        ("zonepack", "inspect", name),
                        ("zoned", "replay", "--config", CONFIG, "--map", "map", "--can", name),
                        ("zoned", "replay", "--config", name, "--map", "map", "--can", LOG),
                        ("zoned", "replay", "--recording", name)):
            says(run(*command, code=1), words)


def not_utf8():
    """A zone file whose name has a byte that is no text: refused by name, and --json is JSON all the same."""
    drawn = (DATA / "zones.geojson").read_bytes()
    Path("bytes.geojson").write_bytes(drawn.replace(b'"name": "', b'"name": "\xff', 1))
    command = [str(BIN / "zonepack"), "check-zones", "bytes.geojson", "--db", str(DATA / "hospital-small.db"), "--json",
               "-"]
    done = subprocess.run(command, capture_output=True, check=False, timeout=120)
    need(done.returncode == 1, f"check-zones of what is no text: exit code {done.returncode}, not 1")
    says(json.dumps(json.loads(done.stdout.decode())), "ill-formed UTF-8 byte")
    says(done.stderr.decode(errors="replace"), "bytes.geojson")
    odd = os.fsencode("odd") + b"\xff.log"
    Path(os.fsdecode(odd)).write_bytes(LOG.read_bytes())
    command = [str(BIN / "zoned"), "replay", "--config", str(CONFIG), "--map", "map", "--can", odd, "--json", "-"]
    done = subprocess.run(command, capture_output=True, check=False, timeout=120)
    need(done.returncode == 0, f"replay of a file whose name is no text: exit code {done.returncode}, not 0")
    json.loads(done.stdout.decode())


def no_budget():
    need(not re.search(r"^\s*budget:", CONFIG.read_text(), re.M), f"{CONFIG} has a budget")
    told = run("zoned", "run", *PLAYED, "--can", f"log:{LOG}@1000")
    words = (r"memory\.budget is not set: 1\.04 MiB \(1092264 bytes\), the smallest for this map; up to [\d.]+ [MG]iB, "
             "a quarter of the memory here, would be taken")
    need(re.search(words, told), f"does not say the default budget: {told}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        run("zonepack", "build", "--db", DATA / "hospital-small.db", "--zones", DATA / "zones.geojson", "--out", "map")
        for part in (other_frames, another_day, clock_set, no_signatures, written_meanwhile, not_the_file_itself,
                     not_utf8, no_budget):
            part()
            print(f"{part.__name__}: as it should be")


main()
