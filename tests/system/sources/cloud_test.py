#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: cloud_test.py BIN SOURCE: point clouds, made of the sample database's laser scans and features.

PCD in its three encodings, a folder of Autoware's tiles and a dump of GLIM give back every point, bit for bit, and no tile
crosses the border of a zone that it can be cut at; then every kind of bad input, each refused by name with exit code 1.
"""
import json
import math
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from source_tools import (BIN, DATABASE, SOURCE, ZONES, build, check_memory, inside, near_border,
                          need, polygons, refused, zonepack)

sys.path.insert(0, str(SOURCE / "tests/support"))
import hospital_cloud as clouds  # noqa: E402


def exported(folder):
    zonepack("verify", folder)
    return [json.loads(line) for line in zonepack("export", folder).stdout.splitlines()]


def check_pcd(work, points):
    expected = sorted(points)
    packs = {}
    for data in ("ascii", "binary", "binary_compressed"):
        clouds.write_pcd(work / f"{data}.pcd", points, data)
        done = build(work / f"{data}.pcd", work / data, "--json", work / "build.json")
        need(f"{len(points)} points in " in done.stderr, done.stderr)
        tiles = exported(work / data)
        need(sorted(tuple(p) for tile in tiles for p in tile["points"]) == expected, f"{data}: points differ")
        packs[data] = sorted(path.name for path in (work / data).glob("*.zpk"))
        sizes = json.loads((work / "build.json").read_text())
        need(0.3 < sizes["charged_over_source"] < 0.85, f"{data}: charged {sizes['charged_over_source']} of its points")
    need(packs["ascii"] == packs["binary"] == packs["binary_compressed"], "the encodings give other packs")
    rings = polygons()
    for tile in tiles:
        need(tile["fields"] == ["x", "y", "z", "intensity", "rgb", "ring"], f"fields {tile['fields']}")
        xs, ys = [p[0] for p in tile["points"]], [p[1] for p in tile["points"]]
        need(math.floor(min(xs) / 10) == math.floor(max(xs) / 10), "a tile is wider than 10 m")
        need(math.floor(min(ys) / 10) == math.floor(max(ys) / 10), "a tile is longer than 10 m")
        ring = rings[tile["zone"]]
        here = [inside(ring, p[0], p[1]) or near_border(ring, p[0], p[1]) for p in tile["points"]]
        need(all(here) or not any(here), f"tile {tile['tile']} crosses the border of {tile['zone']}")
    build(work / "binary.pcd", work / "small", "--tile", 2)
    need(len(exported(work / "small")) > 2 * len(tiles), "--tile 2 gives no more tiles")


def check_folders(work, points, submaps):
    clouds.write_autoware(work / "autoware", points, 20)
    (work / "autoware" / "left.pcd").write_bytes((work / "binary.pcd").read_bytes())
    done = build(work / "autoware", work / "packed-autoware")
    need("left.pcd: is not named in pointcloud_map_metadata.yaml" in done.stderr, done.stderr)
    tiles = exported(work / "packed-autoware")
    need(sorted(tuple(p) for tile in tiles for p in tile["points"]) == sorted(points), "autoware: points differ")
    need({tile["file"] for tile in tiles} == {p.name for p in (work / "autoware").glob("tile_*.pcd")}, "autoware: tiles")
    clouds.write_glim(work / "glim", submaps)
    build(work / "glim", work / "packed-glim")
    tiles = {tile["file"]: tile for tile in exported(work / "packed-glim")}
    for i, (_, _, T, own) in enumerate(submaps):
        tile = tiles[f"{i:06d}"]
        need(sorted(map(tuple, tile["points"])) == sorted(p[:3] for p in own), f"glim: points of submap {i} differ")
        off = max(abs(a - b) for a, b in zip(tile["T_map_points"], [v for row in T[:3] for v in row]))
        need(off < 1e-4, f"glim: submap {i} has moved by {off}")
    for kind in ("pcd", "autoware", "glim"):
        zonepack("report", work / ("binary" if kind == "pcd" else f"packed-{kind}"), "--out", work / f"{kind}.svg")
        zonepack("plan", work / ("binary" if kind == "pcd" else f"packed-{kind}"))


def check_other_fields(work):
    """Coordinates of 64 bits are kept to a micrometre; fields that are not carried are named; NaN is left out."""
    fields = (("x", "F", 8), ("y", "F", 8), ("z", "F", 8), ("normal_x", "F", 4), ("intensity", "U", 1))
    points = [(-3.123456789012 + i / 7, -12.98765432109 + i / 11, 0.1 * i, 0.5, i) for i in range(100)]
    (work / "wide.pcd").write_bytes(clouds.header(101, "binary", fields) + b"".join(
        struct.pack("<3dfB", *p) for p in points) + struct.pack("<3dfB", math.nan, 0, 0, 0, 0))
    done = build(work / "wide.pcd", work / "wide")
    need("1 of 101 points are not finite" in done.stderr and "normal_x" in done.stderr, done.stderr)
    found = []
    for tile in exported(work / "wide"):
        T = tile["T_map_points"]
        found += [(T[3] + x, T[7] + y, T[11] + z, i) for x, y, z, i in tile["points"]]
    need(len(found) == 100, f"{len(found)} points of 100")
    for p, q in zip(sorted(points, key=lambda p: p[4]), sorted(found, key=lambda q: q[3])):
        need(math.dist(p[:3], q[:3]) < 2e-6, f"{p} has become {q}")


def check_bad(work, points):
    few = points[:50]
    def pcd(data):
        clouds.write_pcd(work / "few.pcd", few, data)
        return (work / "few.pcd").read_bytes()
    ascii_, binary, compressed = pcd("ascii"), pcd("binary"), pcd("binary_compressed")
    refused(work, "cut_ascii.pcd", ascii_[:ascii_.rindex(b"\n", 0, -1) + 1], "point 50 of 50: the file ends before it")
    refused(work, "cut.pcd", binary[:-1], "expected 50 points of 22 bytes, found 49")
    refused(work, "cut_compressed.pcd", compressed[:-1], "ends too early")
    refused(work, "many.pcd", binary.replace(b"WIDTH 50", b"WIDTH 1000000000").replace(b"POINTS 50", b"POINTS 1000000000"),
            "expected 1000000000 points")
    refused(work, "huge.pcd", binary.replace(b"POINTS 50", b"POINTS 99999999999999999999"), "line 10", "whole number")
    refused(work, "two.pcd", binary.replace(b"POINTS 50", b"POINTS 51"), "POINTS says 51, WIDTH times HEIGHT 50")
    refused(work, "nofields.pcd", b"VERSION 0.7\nPOINTS 1\nDATA ascii\n1\n", "expected FIELDS before DATA")
    refused(work, "noxyz.pcd", ascii_.replace(b"FIELDS x y", b"FIELDS u v"), "expected fields x, y and z")
    refused(work, "size3.pcd", ascii_.replace(b"SIZE 4", b"SIZE 3"), "expected SIZE 1, 2, 4 or 8")
    refused(work, "type.pcd", ascii_.replace(b"TYPE F", b"TYPE Q"), "expected TYPE F, I or U")
    refused(work, "count.pcd", ascii_.replace(b"COUNT 1", b"COUNT 1 1"), "expected COUNT of each of the 6 FIELDS")
    refused(work, "data.pcd", ascii_.replace(b"DATA ascii", b"DATA zip"), "expected DATA ascii, binary or binary_compressed")
    refused(work, "headless.pcd", b"VERSION 0.7\n" + b"# " * 40000, "line 2")
    refused(work, "word.pcd", ascii_.replace(b"\nDATA ascii\n", b"\nDATA ascii\nnowhere 1 1 1 1 1\n"),
            "point 1 of 50: expected a number as x")
    refused(work, "short_line.pcd", ascii_.replace(b"\nDATA ascii\n", b"\nDATA ascii\n1 2\n"), "point 1 of 50")
    lying = bytearray(compressed)
    at = lying.index(b"DATA binary_compressed\n") + 23
    struct.pack_into("<I", lying, at, 0xFFFFFFFF)
    refused(work, "lying.pcd", bytes(lying), "ends too early")
    for byte in range(at + 8, at + 40):  # a run or a match that is none
        broken = bytearray(compressed)
        broken[byte] ^= 0xE0
        (work / "broken.pcd").write_bytes(broken)
        done = subprocess.run([BIN / "zonepack", "build", "--db", work / "broken.pcd", "--zones", ZONES, "--out",
                               work / "broken"], capture_output=True, text=True, check=False, timeout=60)
        need(done.returncode in (0, 1), f"broken at {byte}: {done.stderr}")
    refused(work, "none.pcd", ascii_[:ascii_.index(b"DATA")].replace(b" 50", b" 0") + b"DATA ascii\n", "holds no signatures")
    refused(work, "far.pcd", b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 1\nDATA ascii\n"
            b"1e30 nan 0\n", "holds no signatures")
    refused(work, "overflow.pcd", b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 8\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 2\nDATA ascii\n"
            b"1e39 1 1\n1 1 -1e999\n", "holds no signatures")
    (work / "spool.pcd").write_bytes(binary)
    done = build(work / "spool.pcd", work / "never", code=1, TMPDIR=str(work / "missing"))
    need("TMPDIR" in done.stderr, done.stderr)
    build(work / "spool.pcd", work / "never", "--tile", 0, code=2)
    (work / "autoware" / "tile_0.pcd").write_bytes(ascii_.replace(b"ring", b"lane"))
    refused(work, "autoware", None, "has other fields than")
    (work / "autoware" / "tile_0.pcd").unlink()
    refused(work, "autoware", None, "names the tile tile_0.pcd, which is not in the folder")
    text = work / "glim" / "000003" / "data.txt"
    good = text.read_text()
    text.write_text(good.replace("T_world_origin", "T_other"))
    refused(work, "glim", None, "000003/data.txt: T_world_origin: expected 16 numbers")
    text.write_text(good.replace("T_world_origin: \n", "T_world_origin: \n9 9 9 9 "))
    refused(work, "glim", None, "expected a rotation")
    text.write_text(good)
    (work / "glim" / "000003" / "points_compact.bin").write_bytes(b"\0" * 13)
    refused(work, "glim", None, "expected points of 12 bytes, found 13 bytes")
    (work / "glim" / "000003" / "points_compact.bin").unlink()
    refused(work, "glim", None, "points_compact.bin: is missing")
    (work / "empty").mkdir()
    refused(work, "empty", None, "is a folder")


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        submaps = list(clouds.submaps_of(DATABASE))
        points = [tuple(clouds.single(v) for v in clouds.place(T, p[:3])) + p[3:] for _, _, T, own in submaps for p in own]
        check_pcd(work, points)
        check_folders(work, points, submaps)
        check_other_fields(work)
        check_bad(work, points)
    check_memory()
    print("cloud_test: every point comes back, and bad clouds are refused by name")


if __name__ == "__main__":
    main()
