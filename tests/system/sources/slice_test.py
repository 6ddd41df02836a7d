#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: slice_test.py BIN SOURCE: floor plans of maps without grids, sliced at the height of a robot.

A building of two rooms, written as every kind of cloud and as nvblox maps: suggest-zones finds two rooms and the door
between them, and each command that draws shows the same floor plan. Then clouds that slope, have no floor, or
reach to the horizon. With ZONEPACK_HOSPITAL_DB, depth images of that database: suggested zones are packed and have no fault.
"""
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
from array import array
from pathlib import Path

from source_tools import BIN, DATABASE, SOURCE, check_memory, need, zonepack

sys.path.insert(0, str(SOURCE / "tests/support"))
import hospital_cloud as clouds  # noqa: E402
import nvblox_map as nvblox  # noqa: E402
import two_rooms  # noqa: E402


def colored(points):
    return [(*map(clouds.single, p), 0.0, 0, 0) for p in points]


def submaps_of(points):
    """A frame of its own for every three metres, turned and raised."""
    parts = {}
    for x, y, z in points:
        parts.setdefault(math.floor(x / 3), []).append((x, y, z))
    for i, (_, own) in enumerate(sorted(parts.items())):
        c, s, at = math.cos(0.5 * i), math.sin(0.5 * i), (3.0 * i, -1.0, 0.4)
        T = [[c, -s, 0, at[0]], [s, c, 0, at[1]], [0, 0, 1, at[2]], [0, 0, 0, 1]]
        local = [(c * (x - at[0]) + s * (y - at[1]), c * (y - at[1]) - s * (x - at[0]), z - at[2]) for x, y, z in own]
        yield i, 100.0 + i, T, colored(local)


def write_blocks(path, layer, size=0.8):
    layers = {"tsdf_layer": {}, layer: two_rooms.blocks(layer)}
    database = nvblox.create(path, layers, size)
    for name, blobs in layers.items():
        database.executemany(f"INSERT INTO {name}_data VALUES (?, ?, ?, ?)", ((*i, blob) for i, blob in blobs.items()))
    database.commit()
    database.close()


def suggested(source, *options):
    """What suggest-zones says of a map, in zones.geojson beside it."""
    out = source.parent / f"{source.name}.geojson"
    zonepack("suggest-zones", "--db", source, "--out", out, "--json", source.parent / "suggested.json", *options)
    return out, json.loads((source.parent / "suggested.json").read_text())


def check_two_rooms(source, *options, cell=0.05):
    zones, found = suggested(source, *options)
    need(len(found["zones"]) == 2 and len(found["portals"]) == 1, f"{source.name}: {found['zones']}, {found['portals']}")
    width, areas = found["portals"][0]["width_m"], sorted(zone["area_m2"] for zone in found["zones"])
    # A wall takes the cells that it stands in, so rooms and doors may lose two on each side.
    need(1 - 4 * cell <= width <= 1 + cell, f"{source.name}: the door is {width} m wide, not 1 m")
    for area, (x, y) in zip(areas, ((4, 5), (5, 5))):
        need((x - 4 * cell) * (y - 4 * cell) <= area <= x * y, f"{source.name}: areas {areas}")
    return zones


def shows_a_plan(picture):
    return "<image" in picture.read_text()


def check_commands(source, zones):
    """check-zones, report (of the map and of its packs) and outline show the plan that suggest-zones was given."""
    work = source.parent
    zonepack("check-zones", zones, "--db", source, "--out", work / "check.svg", "--json", work / "check.json")
    check = json.loads((work / "check.json").read_text())
    need(check["faults"] == [] and len(check["portals"]) == 1, f"{source.name}: {check['faults']}")
    need(shows_a_plan(work / "check.svg"), f"{source.name}: check-zones draws no plan")
    shutil.rmtree(work / "packed", ignore_errors=True)
    zonepack("build", "--db", source, "--zones", zones, "--out", work / "packed")
    zonepack("verify", work / "packed")
    for name, options in (("packs", ()), ("source", ("--db", source))):
        said = zonepack("report", work / "packed", "--out", work / f"{name}.svg", *options).stderr
        need("warning" not in said, f"{source.name}: report from its {name}: {said}")
        need(shows_a_plan(work / f"{name}.svg"), f"{source.name}: report from its {name} draws no plan")
    zonepack("outline", "--db", source, "--out", work / "outline", "--json", work / "outline.json")
    plan = json.loads((work / "outline.json").read_text())["map"]
    need(plan["source"] == "a slice" and plan["detail"].startswith("0.2 to 1.5 m above the floor at z "), str(plan))
    zonepack("suggest-zones", "--grid", work / "outline/map.yaml", "--out", work / "grid.geojson")
    need((work / "grid.geojson").read_bytes() == zones.read_bytes(), f"{source.name}: outline draws another plan")


def check_kinds(work):
    points = two_rooms.surface_points()
    clouds.write_pcd(work / "rooms.pcd", colored(points), "binary")
    clouds.write_autoware(work / "autoware", colored(points), 4)
    clouds.write_glim(work / "glim", submaps_of(points))
    for name in ("rooms.pcd", "autoware", "glim"):
        check_commands(work / name, check_two_rooms(work / name))
    one, tiled = (check_two_rooms(work / "rooms.pcd", *options).read_bytes() for options in ((), ("--tile", 1.5)))
    need(one == tiled, "the tiles of a cloud change its floor plan")
    need(one == (work / "autoware.geojson").read_bytes(), "tiles of Autoware give another floor plan than their cloud")
    for layer in ("tsdf_layer", "occupancy_layer", "esdf_layer"):
        write_blocks(work / f"{layer}.nvblx", layer)
        check_commands(work / f"{layer}.nvblx", check_two_rooms(work / f"{layer}.nvblx", cell=0.1))


def check_heights(work):
    """The table stands 0.7 to 0.75 m above the floor: a robot of 0.6 m drives below it."""
    source = work / "rooms.pcd"
    occupied = []
    for heights in ("0.2,1.5", "0.2,0.6"):
        zonepack("outline", "--db", source, "--out", work / "outline", "--slice", heights, "--json", work / "outline.json")
        occupied.append(json.loads((work / "outline.json").read_text())["map"]["occupied_cells"])
    under = (occupied[0] - occupied[1]) * 0.05 ** 2
    need(1.0 <= under <= 1.5, f"the table covers {under} m2, not 1.2")
    for wrong in ("0.2", "1.5,0.2", "0,1", "0.2,nan", "0.2,1.5,2", "a,b", "0.2,11"):
        done = zonepack("outline", "--db", source, "--out", work / "outline", "--slice", wrong, code=2)
        need("--slice" in done.stderr and "LOW,HIGH" in done.stderr, done.stderr)


def check_depth_images(work):
    """What a camera saw of a hospital: surfaces with holes, seen from the side."""
    program, database = BIN / "fuse_depth", os.environ.get("ZONEPACK_HOSPITAL_DB")
    if not program.exists() or not database:
        print("the building of depth images is left out: it needs fuse_depth and ZONEPACK_HOSPITAL_DB")
        return
    done = subprocess.run([program, database, work / "depth.nvblx", work / "depth.pcd"], capture_output=True, text=True,
                          check=True)
    print(done.stdout.strip())
    for name in ("depth.pcd", "depth.nvblx"):
        zones, found = suggested(work / name)
        print(f"{name}: {len(found['zones'])} zones, {len(found['portals'])} portals")
        need(len(found["zones"]) >= 3, f"{name}: {found['zones']}")
        zonepack("build", "--db", work / name, "--zones", zones, "--out", work / f"{name}-map")
        zonepack("check-zones", zones, "--db", work / name, "--json", work / "check.json")
        check = json.loads((work / "check.json").read_text())
        need(check["faults"] == [], f"{name}: {check['faults']}")


def check_slopes(work):
    for degrees in (1, 3):
        clouds.write_pcd(work / "slope.pcd", colored(two_rooms.surface_points(tilt=math.radians(degrees))), "binary")
        check_two_rooms(work / "slope.pcd")


def no_floor(source, *said):
    """Refused by name, and outline goes on without a plan."""
    done = zonepack("suggest-zones", "--db", source, "--out", source.parent / "none.geojson", code=1)
    for words in (source.name, "--grid", *said):
        need(words in done.stderr, f"{source.name}: expected '{words}' in: {done.stderr}")
    need(not (source.parent / "none.geojson").exists(), f"{source.name}: left zones")
    done = zonepack("outline", "--db", source, "--out", source.parent / "none")
    need("no map.pgm" in done.stdout and not (source.parent / "none" / "map.pgm").exists(), done.stdout)


def write_floats(path, numbers):
    with open(path, "wb") as out:
        out.write(clouds.header(len(numbers) // 3, "binary", clouds.FIELDS[:3]))
        numbers.tofile(out)


def check_bad(work):
    points = two_rooms.surface_points(step=0.06)
    walls = [p for p in points if 0.3 < p[2] < 2.3 and not (two_rooms.TABLE[0] < p[0] < two_rooms.TABLE[2] and
                                                            two_rooms.TABLE[1] < p[1] < two_rooms.TABLE[3])]
    clouds.write_pcd(work / "walls.pcd", colored(walls), "binary")
    no_floor(work / "walls.pcd", "no floor in its points", "if z is not up")
    clouds.write_pcd(work / "point.pcd", colored([(1, 2, 3)]), "ascii")
    no_floor(work / "point.pcd", "no floor in its points")
    zonepack("build", "--db", DATABASE, "--zones", SOURCE / "tests/data/zones.geojson", "--out", work / "flat",
             "--payload", "features,scan")  # scans of one plane, and no grids
    zonepack("report", work / "flat", "--out", work / "flat.svg")
    need(not shows_a_plan(work / "flat.svg"), "a plan was drawn of scans in one plane")

    nowhere = [(math.nan, 0, 0), (0, math.inf, 0), (0, 0, -math.inf), (3e38, 3e38, 0)]
    chance = random.Random(4)
    strays = [(chance.uniform(-5e3, 5e3), chance.uniform(-5e3, 5e3), chance.uniform(-50, 50)) for _ in range(2000)]
    clouds.write_pcd(work / "strays.pcd", colored(two_rooms.surface_points() + nowhere + strays), "binary")
    check_two_rooms(work / "strays.pcd")


def check_wide(work):
    """A floor kilometres away makes cells coarser; points in too many places are refused. Both in little memory."""
    numbers = array("f")
    for x, y, z in two_rooms.surface_points():
        numbers.extend((x, y, z, x + 1500, y + 1500, z))
    write_floats(work / "wide.pcd", numbers)
    done = zonepack("outline", "--db", work / "wide.pcd", "--out", work / "wide")
    need("cells of 0.2 m instead of 0.05;" in done.stdout, done.stdout)
    numbers = array("f")
    for x in range(660):
        for y in range(660):
            for z in range(5):
                numbers.extend((2 * x + 1, 2 * y + 1, z))
    write_floats(work / "everywhere.pcd", numbers)
    done = zonepack("suggest-zones", "--db", work / "everywhere.pcd", "--out", work / "none.geojson", code=1)
    need("everywhere.pcd" in done.stderr and "cut the map" in done.stderr, done.stderr)
    check_memory()


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        check_kinds(work)
        check_heights(work)
        check_slopes(work)
        check_bad(work)
        check_wide(work)
        check_depth_images(work)
    print("slice_test: two rooms and a door in every kind, and bad maps are refused by name")


if __name__ == "__main__":
    main()
