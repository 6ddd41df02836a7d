#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: kinds.py BIN SOURCE DB [--rounds N] [NAME MAP RAW] ...: what each kind of map costs, a row of a table each.

Writes the features, scans and points of an RTAB-Map database as the other kinds, packs them with tests/data/zones.geojson
(of which they may stand far) and measures: the source's own bytes, what they charge and store, what LZ4 HC 9 makes of them
as they are, in blocks of 64 KiB, and how long a cold zone takes from the decision to its use, beside dd of the same bytes.
NAME MAP RAW adds a row for a map that is packed already, RAW being a file of the source's bytes.
"""
import argparse
import json
import os
import re
import sqlite3
import struct
import subprocess
import sys
import tempfile
from pathlib import Path


def rtabmap_bytes(db):
    """Feature rows, 72 bytes each, and the blobs of scans and grids as they are."""
    with sqlite3.connect(f"file:{db}?mode=ro", uri=True) as database:
        for row in database.execute("SELECT word_id, pos_x, pos_y, size, dir, response, octave, depth_x, depth_y, depth_z,"
                                    " descriptor FROM Feature ORDER BY node_id, rowid"):
            yield struct.pack("<i5fi3f", row[0], *row[1:6], row[6], *(float("nan") if v is None else v for v in row[7:10]))
            yield row[10] or b""
        for row in database.execute("SELECT scan, ground_cells, obstacle_cells, empty_cells FROM Data ORDER BY id"):
            yield from (blob for blob in row if blob)


def stella_bytes(path):
    """The features and landmarks of a map in SQLite, as its tables hold them."""
    with sqlite3.connect(f"file:{path}?mode=ro", uri=True) as database:
        for row in database.execute("SELECT undist_keypts, descs, lm_ids FROM keyframes JOIN associations USING (id) ORDER BY id"):
            yield from row
        for row in database.execute("SELECT pos_w FROM landmarks ORDER BY id"):
            yield row[0]


def packed_points(clouds, points):
    """The fields that a point has, 4 bytes each."""
    for p in points:
        yield struct.pack("<4fIf", *p[:5], float(p[5]))


def joined(clouds, inverse, submaps, frames):
    """Submaps of so many frames each, in the frame of their first: as GLIM makes them."""
    for first in range(0, len(submaps), frames):
        number, stamp, T, _ = submaps[first]
        back = inverse(T)
        yield number, stamp, T, [tuple(map(clouds.single, clouds.place(back, clouds.place(U, p[:3])))) + p[3:]
                                 for _, _, U, points in submaps[first:first + frames] for p in points]


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"{command}: {done.stderr}")
    return done.stdout


def lz4_size(raw):
    with tempfile.NamedTemporaryFile(dir=raw.parent) as out:
        run("lz4", "-9", "-B4", "-BI", "-q", "-f", raw, out.name)
        return os.path.getsize(out.name)


def row(bin_, name, folder, raw, charged, stored, rounds):
    latency = run("taskset", "-c", "0", bin_ / "zone_latency", folder, rounds)
    of = {line[:26].strip(): line[26:].split() for line in latency.splitlines() if re.match(r".{26} +\d", line)}
    dd, load, times, itself = (of[key] for key in ("dd, ms", "decision to usable, ms", "times dd", "dd itself, times dd"))
    size, packed = raw.stat().st_size, lz4_size(raw)
    print(f"| {name} | {size / 2**20:.2f} | {charged / 2**20:.2f}, {charged / size:.2f} | "
          f"{stored / 2**20:.2f}, {stored / packed:.2f} | {load[0]} / {dd[0]} | {times[0]} | "
          f"{float(times[1]) / float(itself[1]):.2f} |", flush=True)


def costs(bin_, folder):
    """Charged and stored bytes of a map."""
    plan = json.loads(run(bin_ / "zonepack", "plan", folder, "--json", "-"))
    inspected = json.loads(run(bin_ / "zonepack", "inspect", folder, "--json", "-"))
    return sum(zone["charged_bytes"] for zone in plan["zones"]), sum(zone["pack_bytes"] for zone in inspected["zones"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=Path)
    parser.add_argument("source", type=Path)
    parser.add_argument("db", type=Path)
    parser.add_argument("--rounds", type=int, default=21)
    parser.add_argument("others", nargs="*", metavar="NAME MAP RAW")
    options = parser.parse_args()
    sys.path.insert(0, str(options.source / "tests/support"))
    import hospital_cloud as clouds
    import stella_map
    zones = options.source / "tests/data/zones.geojson"
    # On a disk: what lies in memory is never cold.
    with tempfile.TemporaryDirectory(dir=os.environ.get("TMPDIR", "/var/tmp")) as folder:
        work = Path(folder)
        made = stella_map.StellaMap(*stella_map.read_rtabmap(options.db, 10**9), 1.0, "RGBD")
        made.write_sqlite(work / "map.db")
        made.write_msgpack(work / "map.msg", False)
        (work / "base.txt").write_text("".join(f"{stamp:.9f} " + " ".join(f"{v:.9f}" for v in p + q) + "\n"
                                               for stamp, p, q in made.trajectory), encoding="ascii")
        submaps = list(clouds.submaps_of(options.db))
        points = [tuple(clouds.single(v) for v in clouds.place(T, p[:3])) + p[3:] for _, _, T, own in submaps for p in own]
        clouds.write_pcd(work / "cloud.pcd", points, "binary")
        clouds.write_autoware(work / "autoware", points, 10)
        clouds.write_glim(work / "glim", joined(clouds, stella_map.inverse, submaps, 20))
        clouds.write_glim(work / "small-glim", submaps)
        (work / "rtabmap.raw").write_bytes(b"".join(rtabmap_bytes(options.db)))
        (work / "stella.raw").write_bytes(b"".join(stella_bytes(work / "map.db")))
        (work / "cloud.raw").write_bytes(b"".join(packed_points(clouds, points)))
        for dump in ("glim", "small-glim"):
            files = sorted((work / dump).glob("*/*.bin"))
            (work / f"{dump}.raw").write_bytes(b"".join(path.read_bytes() for path in files))
        placed = ("--align", work / "base.txt", "--camera-in-base", "0.2,0,0.5,0,0,0")
        print("| kind | source, MiB | charged, MiB, of it | stored, MiB, of LZ4 HC 9 | cold zone / dd, ms | times dd, p50 | p99 of p99 |")
        print("|---|---|---|---|---|---|---|")
        for name, path, raw, placing in (("rtabmap", options.db, "rtabmap.raw", ()), ("stella (SQLite)", "map.db", "stella.raw", placed),
                                         ("stella (MessagePack)", "map.msg", "stella.raw", placed), ("pcd", "cloud.pcd", "cloud.raw", ()),
                                         ("autoware", "autoware", "cloud.raw", ()), ("glim, 20 frames a submap", "glim", "glim.raw", ()),
                                         ("glim, one frame a submap", "small-glim", "small-glim.raw", ())):
            run(options.bin / "zonepack", "build", "--db", work / path, "--zones", zones, "--out", work / f"packed-{path}".replace("/", "-"),
                "--payload", "features,scan,grid", "--json", work / "build.json", *placing)
            built = json.loads((work / "build.json").read_text())
            row(options.bin, name, work / f"packed-{path}".replace("/", "-"), work / raw, built["charged_bytes"], built["stored_bytes"],
                options.rounds)
        for name, packed, raw in zip(*[iter(options.others)] * 3):
            row(options.bin, name, packed, Path(raw), *costs(options.bin, packed), options.rounds)


if __name__ == "__main__":
    main()
