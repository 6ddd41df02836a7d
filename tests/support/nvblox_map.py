#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fuses the laser scans of an RTAB-Map database into an nvblox map and writes it, value by value.

usage: nvblox_map.py DB OUT.nvblx [SCANS [RANGE_M [COPIES]]]

Every wall is taken to be upright and about a metre high; a sensor 0.5 m above the ground sees it in each of 20 rows of
voxels, so distances are those along its rays. SCANS of them, next to each other, are fused up to RANGE_M: TSDF with
nvblox's weights (1 / range^2, falling off behind the surface, at most 5) and a truncation of 4 voxels of 5 cm, occupancy
as log odds, a made-up colour with noise, and an ESDF by a brush fire. COPIES of it side by side make a large map.
"""
import heapq
import math
import random
import sqlite3
import struct
import sys
import zlib
from array import array

from stella_map import matrix, place, read_rtabmap

VOXEL = 0.05
SIDE = 8
BLOCK = struct.unpack("f", struct.pack("f", VOXEL * SIDE))[0]
TRUNCATION = 4 * VOXEL
MOST_WEIGHT = 5.0
SENSOR_M, ROWS = 0.5, 20
FAR_VOXELS = 20  # of the ESDF
FREE, OCCUPIED, MOST_ODDS = math.log(0.3 / 0.7), math.log(0.7 / 0.3), 3.5
LAYERS = ("tsdf_layer", "color_layer", "occupancy_layer", "esdf_layer")


def scans_of(db, first, count):
    """(x, y) of the sensor in the map, yaw, and its points' distances by angle."""
    signatures, _ = read_rtabmap(db, 10**9)
    with sqlite3.connect(f"file:{db}?mode=ro", uri=True) as database:
        for number, _, T_map_base, _ in signatures[first:first + count]:
            scan, info = database.execute("SELECT scan, scan_info FROM Data WHERE id=?", (number,)).fetchone()
            if not scan:
                continue
            mount = matrix(struct.unpack("<19f", info)[7:19])
            x, y, _ = place(T_map_base, place(mount, (0, 0, 0)))
            beams = []
            for point in struct.iter_unpack("<2f", zlib.decompress(scan[:-12])):
                px, py, _ = place(T_map_base, place(mount, (*point, 0)))
                beams.append((math.atan2(py - y, px - x), math.hypot(px - x, py - y)))
            yield x, y, sorted(beams)


class Fusion:
    """Voxels by block index, as flat lists of 512."""

    def __init__(self):
        self.tsdf, self.odds, self.colour = {}, {}, {}
        self.noise = random.Random(7)

    @staticmethod
    def own(layer, block, types):
        found = layer.get(block)
        if found is None:
            found = layer[block] = [array(kind, bytes(2048)) for kind in types]
        return found

    def add(self, x, y, beams, reach):
        bins = [None] * 720  # half degrees: the beam nearest to each
        for angle, distance in beams:
            middle = int((angle + math.pi) / math.pi * 360) % 720
            for i in (middle - 1, middle, middle + 1):
                if bins[i % 720] is None or i == middle:
                    bins[i % 720] = distance
        lo_x, hi_x = int((x - reach) // VOXEL), int((x + reach) // VOXEL)
        lo_y, hi_y = int((y - reach) // VOXEL), int((y + reach) // VOXEL)
        for ix in range(lo_x, hi_x + 1):
            for iy in range(lo_y, hi_y + 1):
                dx, dy = (ix + .5) * VOXEL - x, (iy + .5) * VOXEL - y
                r = math.hypot(dx, dy)
                if r > reach or r < VOXEL:
                    continue
                surface = bins[int((math.atan2(dy, dx) + math.pi) / math.pi * 360) % 720]
                if surface is not None and surface - r > -TRUNCATION:
                    self.add_column(ix, iy, r, surface)

    def add_column(self, ix, iy, r, surface):
        bx, by = ix // SIDE, iy // SIDE
        at = (ix % SIDE) * 64 + (iy % SIDE) * 8
        for iz in range(ROWS):
            slope = math.sqrt(1 + (((iz + .5) * VOXEL - SENSOR_M) / r) ** 2)
            sdf = (surface - r) * slope
            if sdf < -TRUNCATION:
                continue
            block, i = (bx, by, iz // SIDE), at + iz % SIDE
            distances, weights = self.own(self.tsdf, block, "ff")
            weight = 1 / (r * slope) ** 2
            if sdf < 0:
                weight *= max(0.0, 1 + sdf / TRUNCATION)
            old = weights[i]
            if old + weight > 0:
                fused = (sdf * weight + distances[i] * old) / (weight + old)
                distances[i] = min(TRUNCATION, fused) if fused > 0 else max(-TRUNCATION, fused)
                weights[i] = min(MOST_WEIGHT, old + weight)
            odds = self.own(self.odds, block, "f")[0]
            odds[i] = max(-MOST_ODDS, min(MOST_ODDS, odds[i] + (OCCUPIED if abs(sdf) < VOXEL else FREE)))
            if abs(sdf) < 2 * VOXEL:
                shade = int(120 + 60 * math.sin(ix / 9) + 40 * math.cos(iy / 7)) + self.noise.randrange(-4, 5)
                rgba, seen = self.own(self.colour, block, "If")
                held = rgba[i].to_bytes(4, "little")[:3] if seen[i] else None
                fresh = (shade, shade * 7 // 8, shade // 2 + iz)
                if held:
                    fresh = tuple((3 * a + b) // 4 for a, b in zip(held, fresh))
                rgba[i] = int.from_bytes(bytes((*fresh, 255)), "little")
                seen[i] = min(MOST_WEIGHT, seen[i] + weight)

    def esdf(self):
        """Blobs by block: squared distance and parent (voxels), inside, observed, site, one byte of padding."""
        sites, known = [], {}
        for (bx, by, bz), (distances, weights) in self.tsdf.items():
            for i, (d, w) in enumerate(zip(distances, weights)):
                if w > 0.01:
                    known[(bx * 8 + i // 64, by * 8 + i // 8 % 8, bz * 8 + i % 8)] = d
        best = {}
        for voxel, d in known.items():
            if abs(d) < VOXEL / 2:
                best[voxel] = (0, (0, 0, 0))
                sites.append((0, voxel, voxel))
        heapq.heapify(sites)
        while sites:
            square, voxel, site = heapq.heappop(sites)
            if square > best[voxel][0]:
                continue
            for axis in range(3):
                for step in (-1, 1):
                    near = voxel[:axis] + (voxel[axis] + step,) + voxel[axis + 1:]
                    way = tuple(s - n for s, n in zip(site, near))
                    far = way[0] ** 2 + way[1] ** 2 + way[2] ** 2
                    if near in known and far <= FAR_VOXELS ** 2 and (near not in best or far < best[near][0]):
                        best[near] = (far, way)
                        heapq.heappush(sites, (far, near, site))
        pack = struct.Struct("<f3i4B").pack
        blobs = {}
        for bx, by, bz in self.tsdf:
            out = []
            for i in range(512):
                voxel = (bx * 8 + i // 64, by * 8 + i // 8 % 8, bz * 8 + i % 8)
                d = known.get(voxel)
                far, way = best.get(voxel, (FAR_VOXELS ** 2 if d is not None else 0, (0, 0, 0)))
                out.append(pack(far, *way, d is not None and d < 0, d is not None, far == 0 and d is not None, 0))
            blobs[(bx, by, bz)] = b"".join(out)
        return blobs


def interleaved(planes):
    whole = bytearray(2048 * len(planes))
    words = memoryview(whole).cast("I")
    for i, plane in enumerate(planes):
        words[i::len(planes)] = memoryview(plane).cast("B").cast("I")
    return bytes(whole)


def fuse(db, scans=10, reach=4.0, first=0):
    """Of each layer: blob by block."""
    fusion = Fusion()
    for x, y, beams in scans_of(db, first, scans):
        fusion.add(x, y, beams, reach)
    return {"tsdf_layer": {b: interleaved(p) for b, p in fusion.tsdf.items()},
            "color_layer": {b: interleaved(p) for b, p in fusion.colour.items()},
            "occupancy_layer": {b: interleaved(p) for b, p in fusion.odds.items()},
            "esdf_layer": fusion.esdf()}


def create(path, layers, block_size=BLOCK):
    """The tables, with block_size in the metadata of each."""
    database = sqlite3.connect(path)
    for layer in layers:
        database.execute(f"CREATE TABLE {layer}_metadata (param_name TEXT NOT NULL PRIMARY KEY, value_string TEXT, "
                         "value_int INTEGER, value_float REAL)")
        database.execute(f"CREATE TABLE {layer}_data (index_x INTEGER, index_y INTEGER, index_z INTEGER, data BLOB)")
        database.execute(f"INSERT INTO {layer}_metadata VALUES ('block_size', NULL, NULL, ?)", (block_size,))
        database.execute(f"INSERT INTO {layer}_metadata VALUES ('layer_type', ?, NULL, NULL)", (layer,))
    database.commit()
    return database


def write(path, layers, copies=1):
    """Rows in the order of a hash table, that is in none; copies stand side by side."""
    database = create(path, layers)
    xs = [block[0] for block in layers["tsdf_layer"]]
    width = max(xs) - min(xs) + 1
    shuffled = random.Random(3)
    for layer, blobs in layers.items():
        order = sorted(blobs)
        shuffled.shuffle(order)
        for copy in range(copies):
            database.executemany(f"INSERT INTO {layer}_data VALUES (?, ?, ?, ?)",
                                 ((x + copy * width, y, z, blobs[x, y, z]) for x, y, z in order))
    database.commit()
    database.close()


def main():
    if not 3 <= len(sys.argv) <= 6:
        sys.exit(__doc__)
    scans, reach, copies = (*sys.argv[3:], "10", "4", "1")[:3] if len(sys.argv) == 3 else (
        *sys.argv[3:], *("10", "4", "1")[len(sys.argv) - 3:])
    write(sys.argv[2], fuse(sys.argv[1], int(scans), float(reach)), int(copies))


if __name__ == "__main__":
    main()
