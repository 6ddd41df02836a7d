#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes point clouds of an RTAB-Map database's laser scans and features, and writes them byte by byte.

usage: hospital_cloud.py DB OUT (ascii|binary|binary_compressed|autoware|glim)

Intensity is made up (a whole number of 0 to 255 by height and distance), rgb too, ring is the row of beams.
"""
import math
import os
import struct
import sys
import zlib
from pathlib import Path

import sqlite3

from stella_map import matrix, place, read_rtabmap

FIELDS = (("x", "F", 4), ("y", "F", 4), ("z", "F", 4), ("intensity", "F", 4), ("rgb", "F", 4), ("ring", "U", 2))
IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def single(value):
    return struct.unpack("f", struct.pack("f", value))[0]


def submaps_of(db, most=10**9):
    """Of each signature: stamp, T_map_base, points (x, y, z, intensity, rgb, ring) in the base frame."""
    signatures, _ = read_rtabmap(db, most)
    with sqlite3.connect(f"file:{db}?mode=ro", uri=True) as database:
        for number, stamp, T_map_base, features in signatures:
            points = []
            scan, info = database.execute("SELECT scan, scan_info FROM Data WHERE id=?", (number,)).fetchone()
            if scan:
                data = zlib.decompress(scan[:-12])
                mount = matrix(struct.unpack("<19f", info)[7:19])
                for i, (x, y) in enumerate(struct.iter_unpack("<2f", data)):
                    p = place(mount, (x, y, 0))
                    points.append((*p, float(min(255, int(25 * math.hypot(x, y)))), 0x202020, i % 16))
            for feature in features:
                if None not in feature[6:9] and all(map(math.isfinite, feature[6:9])):
                    shade = int(feature[4] * 1e6) & 255 if feature[4] else 128
                    points.append((*feature[6:9], float(shade), shade << 16 | 255 - shade, 16))
            yield number, stamp, T_map_base, [tuple(map(single, p[:3])) + p[3:] for p in points]


def cloud_of(db):
    points = []
    for _, _, T, own in submaps_of(db):
        points += [tuple(single(v) for v in place(T, p[:3])) + p[3:] for p in own]
    return points


def record(point):
    return struct.pack("<4fIH", point[0], point[1], point[2], point[3], point[4], point[5])


def lzf(data):
    """LibLZF's format, by a greedy search for the last place of each three bytes."""
    out, literals, last, i = bytearray(), bytearray(), {}, 0

    def flush():
        for at in range(0, len(literals), 32):
            part = literals[at:at + 32]
            out.append(len(part) - 1)
            out.extend(part)
        literals.clear()

    while i < len(data):
        key = data[i:i + 3]
        before = last.get(key)
        last[key] = i
        if len(key) == 3 and before is not None and i - before <= 8192:
            length = 3
            while length < 264 and i + length < len(data) and data[before + length] == data[i + length]:
                length += 1
            flush()
            back = i - before - 1
            if length - 2 < 7:
                out.append((length - 2) << 5 | back >> 8)
            else:
                out.append(7 << 5 | back >> 8)
                out.append(length - 2 - 7)
            out.append(back & 255)
            i += length
        else:
            literals.append(data[i])
            i += 1
    flush()
    return bytes(out)


def header(points, data, fields=FIELDS):
    return ("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + " ".join(f[0] for f in fields) +
            "\nSIZE " + " ".join(str(f[2]) for f in fields) + "\nTYPE " + " ".join(f[1] for f in fields) + "\nCOUNT " +
            " ".join("1" for _ in fields) + f"\nWIDTH {points}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\n"
            f"DATA {data}\n").encode()


def shortest(value):
    """The shortest decimal that gives the same float32."""
    for digits in range(1, 10):
        text = f"{value:.{digits}g}"
        if single(float(text)) == value:
            return text
    return repr(value)


def write_pcd(path, points, data):
    with open(path, "wb") as out:
        out.write(header(len(points), data))
        if data == "ascii":
            for p in points:
                rgb = struct.unpack("f", struct.pack("I", p[4]))[0]
                out.write((" ".join(map(shortest, (*p[:4], rgb))) + f" {p[5]}\n").encode())
        elif data == "binary":
            out.write(b"".join(map(record, points)))
        else:
            columns = [b"".join(struct.pack("<f", p[i]) for p in points) for i in range(4)]
            columns.append(b"".join(struct.pack("<I", p[4]) for p in points))
            columns.append(b"".join(struct.pack("<H", p[5]) for p in points))
            whole = b"".join(columns)
            stored = lzf(whole)
            out.write(struct.pack("<II", len(stored), len(whole)) + stored)


def write_autoware(folder, points, side):
    os.makedirs(folder)
    tiles = {}
    for p in points:
        tiles.setdefault((math.floor(p[0] / side) * side, math.floor(p[1] / side) * side), []).append(p)
    with open(folder / "pointcloud_map_metadata.yaml", "w", encoding="ascii") as out:
        out.write(f"x_resolution: {side:.1f}\ny_resolution: {side:.1f}\n")
        for i, (corner, own) in enumerate(sorted(tiles.items())):
            write_pcd(folder / f"tile_{i}.pcd", own, "binary")
            out.write(f"tile_{i}.pcd: [{corner[0]}, {corner[1]}]\n")


def write_glim(folder, submaps):
    os.makedirs(folder)
    (folder / "graph.txt").write_text("num_submaps: 0\n", encoding="ascii")
    (folder / "traj_lidar.txt").write_text("", encoding="ascii")
    for i, (number, stamp, T, points) in enumerate(submaps):
        os.makedirs(folder / f"{i:06d}")
        rows = "\n".join(" ".join(f"{v:.9f}" for v in row) for row in T)
        eye = "\n".join(" ".join(f"{v:.9f}" for v in row) for row in IDENTITY)
        (folder / f"{i:06d}" / "data.txt").write_text(
            f"id: {i}\nT_world_origin: \n{rows}\nT_origin_endpoint_L: \n{eye}\nT_lidar_imu: \n{eye}\nframe_id: 0\n"
            f"num_frames: 1\nframe_0\nid: {number}\nstamp: {stamp:.9f}\nT_odom_lidar: \n{eye}\n", encoding="ascii")
        (folder / f"{i:06d}" / "points_compact.bin").write_bytes(b"".join(struct.pack("<3f", *p[:3]) for p in points))


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    db, out, form = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
    if form == "glim":
        write_glim(out, submaps_of(db))
    elif form == "autoware":
        write_autoware(out, cloud_of(db), 20)
    else:
        write_pcd(out, cloud_of(db), form)


if __name__ == "__main__":
    main()
