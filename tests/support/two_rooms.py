#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A made-up building of two rooms and a door between them, as surfaces: what mappers of points and of voxels would see.

Rooms of 4 m by 5 m and 5 m by 5 m, 2.5 m high, walls 0.2 m thick. The door is 1 m wide and 2.1 m high. In the first room
stands a table, 0.75 m high, that a robot cannot pass; its top is as level as the floor, but higher and smaller.
"""
import math
import random
import struct

HEIGHT, DOOR_HEIGHT = 2.5, 2.1
DOOR = (2.0, 3.0)  # from and to, along y
WALL_X = (4.0, 4.2)  # of the wall with the door
OUTER = (0.0, 0.0, 9.2, 5.0)
TABLE = (1.5, 3.2, 2.7, 4.2, 0.75)
BOX = ((-0.2, -0.2), (9.4, 5.2))  # with the walls around


def solid(x, y, z):
    """Whether a place is in the floor, a wall, the ceiling or the table."""
    if z < 0 or z > HEIGHT or not (OUTER[0] < x < OUTER[2] and OUTER[1] < y < OUTER[3]):
        return True
    if WALL_X[0] < x < WALL_X[1] and (z > DOOR_HEIGHT or not DOOR[0] < y < DOOR[1]):
        return True
    return TABLE[0] < x < TABLE[2] and TABLE[1] < y < TABLE[3] and TABLE[4] - 0.05 < z < TABLE[4]


def surface_points(step=0.04, noise=0.005, seed=1, tilt=0.0):
    """(x, y, z) on floor, ceiling, walls, table; `tilt` radians around the y axis, so that the floor rises along x."""
    chance = random.Random(seed)
    points = []

    def steps(low, high):
        return [low + (i + 0.5) * step for i in range(int((high - low) / step))]

    def add(x, y, z):
        p = [v + chance.gauss(0, noise) for v in (x, y, z)]
        points.append((p[0] * math.cos(tilt) - p[2] * math.sin(tilt), p[1], p[0] * math.sin(tilt) + p[2] * math.cos(tilt)))

    for x in steps(OUTER[0], OUTER[2]):
        for y in steps(OUTER[1], OUTER[3]):
            for z in (0.0, HEIGHT):
                if not solid(x, y, abs(z - 1e-6)):
                    add(x, y, z)
            if TABLE[0] < x < TABLE[2] and TABLE[1] < y < TABLE[3]:
                add(x, y, TABLE[4])
    for z in steps(0, HEIGHT):
        for x in steps(OUTER[0], OUTER[2]):
            if not WALL_X[0] < x < WALL_X[1]:
                add(x, OUTER[1], z)
                add(x, OUTER[3], z)
        for y in steps(OUTER[1], OUTER[3]):
            add(OUTER[0], y, z)
            add(OUTER[2], y, z)
            if z > DOOR_HEIGHT or not DOOR[0] < y < DOOR[1]:
                add(WALL_X[0], y, z)
                add(WALL_X[1], y, z)
        if z < DOOR_HEIGHT:
            for x in steps(*WALL_X):
                add(x, DOOR[0], z)
                add(x, DOOR[1], z)
    return points


def distance(x, y, z, reach):
    """To the nearest surface, at most `reach` metres, less than 0 inside what is solid; boxes, so exact along the axes."""
    def beside(low, high):  # how far outside of a box, and how far inside
        d = [max(a - v, v - b) for v, a, b in zip((x, y, z), low, high)]
        outside = math.sqrt(sum(max(v, 0) ** 2 for v in d))
        return outside if outside > 0 else max(d)
    far = 9
    wall = min(beside((WALL_X[0], -far, -far), (WALL_X[1], DOOR[0], far)), beside((WALL_X[0], DOOR[1], -far), (WALL_X[1], far, far)),
               beside((WALL_X[0], DOOR[0], DOOR_HEIGHT), (WALL_X[1], DOOR[1], far)))
    table = beside((TABLE[0], TABLE[1], TABLE[4] - 0.05), (TABLE[2], TABLE[3], TABLE[4]))
    inner = -beside((OUTER[0], OUTER[1], 0), (OUTER[2], OUTER[3], HEIGHT))
    return max(-reach, min(reach, wall, table, inner))


def blocks(layer, voxel=0.1, reach=0.4):
    """nvblox blocks of `layer` by index: distances of the building; what is over two voxels behind a surface was not seen."""
    side = voxel * 8
    first = [math.floor(v / side) for v in (*BOX[0], -0.2)]
    last = [math.floor(v / side) for v in (*BOX[1], HEIGHT + 0.2)]
    pack = {"tsdf_layer": lambda d: struct.pack("<2f", d, 1) if d > -2 * voxel else bytes(8),
            "occupancy_layer": lambda d: struct.pack("<f", 0 if d < -2 * voxel else 2 if d < voxel / 2 else -2),
            "esdf_layer": lambda d: struct.pack("<f3i4B", (d / voxel) ** 2, 0, 0, 0, d < 0, d > -2 * voxel, abs(d) < voxel * 0.6, 0)}[layer]
    out = {}
    for bx in range(first[0], last[0] + 1):
        for by in range(first[1], last[1] + 1):
            for bz in range(first[2], last[2] + 1):
                out[bx, by, bz] = b"".join(
                    pack(distance(bx * side + (i // 64 + .5) * voxel, by * side + (i // 8 % 8 + .5) * voxel,
                                  bz * side + (i % 8 + .5) * voxel, reach)) for i in range(512))
    return out
