#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a building of any size: an RTAB-Map database and its zones, to see what grows with a map.

usage: large_building.py ZONES SIGNATURES OUT.db OUT.geojson

A floor is a lobby with up to ten wings; a wing is a corridor of up to twenty pieces, each with two rooms on either
side; stairs lead from lobby to lobby. Floors lie side by side in one plane. Every signature has a pose, links to the
signatures before and after it, and a laser scan of 48 points. The same arguments give the same files.
"""
import json
import math
import random
import sqlite3
import struct
import sys
import zlib

PIECE_M, CORRIDOR_M, ROOM_M, LOBBY_M, STAIRS_M = 12.0, 3.0, 5.0, 10.0, 4.0
WING_M = CORRIDOR_M + 2 * ROOM_M + 1  # a wall of 1 m to the next
PIECES, WINGS = 20, 10
SCANS = 64  # different ones
SCHEMA = """
CREATE TABLE Node (id INTEGER NOT NULL, map_id INTEGER NOT NULL, weight INTEGER, stamp FLOAT, pose BLOB,
  ground_truth_pose BLOB, velocity BLOB, label TEXT, gps BLOB, env_sensors BLOB, time_enter DATE, PRIMARY KEY (id));
CREATE TABLE Data (id INTEGER NOT NULL, image BLOB, depth BLOB, depth_confidence BLOB, calibration BLOB, scan BLOB,
  scan_info BLOB, ground_cells BLOB, obstacle_cells BLOB, empty_cells BLOB, cell_size FLOAT, view_point_x FLOAT,
  view_point_y FLOAT, view_point_z FLOAT, user_data BLOB, time_enter DATE, PRIMARY KEY (id));
CREATE TABLE Link (from_id INTEGER NOT NULL, to_id INTEGER NOT NULL, type INTEGER NOT NULL,
  information_matrix BLOB NOT NULL, transform BLOB, user_data BLOB);
CREATE TABLE Word (id INTEGER NOT NULL, descriptor_size INTEGER NOT NULL, descriptor BLOB NOT NULL, time_enter DATE,
  PRIMARY KEY (id));
CREATE TABLE Feature (node_id INTEGER NOT NULL, word_id INTEGER NOT NULL, pos_x FLOAT NOT NULL, pos_y FLOAT NOT NULL,
  size INTEGER NOT NULL, dir FLOAT NOT NULL, response FLOAT NOT NULL, octave INTEGER NOT NULL, depth_x FLOAT,
  depth_y FLOAT, depth_z FLOAT, descriptor_size INTEGER, descriptor BLOB);
CREATE TABLE Info (STM_size INTEGER, last_sign_added INTEGER, process_mem_used INTEGER, database_mem_used INTEGER,
  dictionary_size INTEGER, parameters TEXT, time_enter DATE);
CREATE TABLE Statistics (id INTEGER NOT NULL, stamp FLOAT, data BLOB, wm_state BLOB);
CREATE TABLE Admin (version TEXT, preview_image BLOB, opt_cloud BLOB, opt_ids BLOB, opt_poses BLOB,
  opt_last_localization BLOB, opt_polygons_size INTEGER, opt_polygons BLOB, opt_tex_coords BLOB,
  opt_tex_materials BLOB, opt_map BLOB, opt_map_x_min FLOAT, opt_map_y_min FLOAT, opt_map_resolution FLOAT,
  dictionary_index BLOB, time_enter DATE);
CREATE TABLE GlobalDescriptor (node_id INTEGER NOT NULL, type INTEGER NOT NULL, info BLOB, data BLOB NOT NULL);
"""


class Plan:
    """Zones as (name, kind, (x0, y0, x1, y1)), and portals as (zone, zone, (x0, y0, x1, y1))."""

    def __init__(self, most):
        self.most = most
        self.zones, self.portals = [], []
        floor, y = 0, 0.0
        while len(self.zones) < most:
            y = self.add_floor(floor, y)
            floor += 1

    def add(self, name, kind, box):
        self.zones.append((name, kind, box))
        return name

    def full(self):
        return len(self.zones) >= self.most

    def add_floor(self, floor, y):
        wings = min(WINGS, max(1, math.ceil((self.most - len(self.zones) - 1) / (5 * PIECES))))
        top = y + wings * WING_M
        lobby = self.add(f"F{floor:03d}-lobby", "lobby", (-LOBBY_M, y, 0.0, top))
        if floor:
            stairs = self.add(f"F{floor:03d}-stairs", "corridor", (-STAIRS_M - 2, y - STAIRS_M, -2.0, y))
            x0, x1 = -STAIRS_M - 1, -3.0
            self.portals.append((stairs, lobby, (x0, y, x1, y)))
            self.portals.append((stairs, f"F{floor - 1:03d}-lobby", (x0, y - STAIRS_M, x1, y - STAIRS_M)))
        for wing in range(wings):
            self.add_wing(f"F{floor:03d}-W{wing}", lobby, y + wing * WING_M)
        return top + STAIRS_M

    def add_wing(self, wing, lobby, y):
        before = lobby
        low, high = y + ROOM_M, y + ROOM_M + CORRIDOR_M
        for piece in range(PIECES):
            if self.full():
                return
            x = piece * PIECE_M
            corridor = self.add(f"{wing}-C{piece:02d}", "corridor", (x, low, x + PIECE_M, high))
            self.portals.append((before, corridor, (x, low + 0.5, x, high - 0.5)))
            before = corridor
            for room in range(4):
                if self.full():
                    return
                x0 = x + (room % 2) * PIECE_M / 2
                y0, y1, door = (y, low, low) if room < 2 else (high, high + ROOM_M, high)
                name = self.add(f"{wing}-R{piece:02d}{'abcd'[room]}", "room", (x0, y0, x0 + PIECE_M / 2, y1))
                self.portals.append((corridor, name, (x0 + 2, door, x0 + 3, door)))


def write_zones(plan, path):
    with open(path, "w", encoding="utf-8") as out:
        out.write('{"type": "FeatureCollection", "features": [\n')
        separator = ""
        for name, kind, (x0, y0, x1, y1) in plan.zones:
            ring = [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]]
            feature = {"type": "Feature", "properties": {"name": name, "zone_type": kind},
                       "geometry": {"type": "Polygon", "coordinates": [ring]}}
            out.write(separator + json.dumps(feature))
            separator = ",\n"
        for a, b, (x0, y0, x1, y1) in plan.portals:
            feature = {"type": "Feature", "properties": {"portal": True, "zones": [a, b]},
                       "geometry": {"type": "LineString", "coordinates": [[x0, y0], [x1, y1]]}}
            out.write(separator + json.dumps(feature))
        out.write("\n]}\n")


def packed(data, rows, columns, kind):
    return zlib.compress(data, 1) + struct.pack("<3i", rows, columns, kind)


def pose(x, y, yaw):
    c, s = math.cos(yaw), math.sin(yaw)
    return struct.pack("<12f", c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0)


def scans(chance):
    """Of a room seen from somewhere in it."""
    made = []
    for _ in range(SCANS):
        width, depth = chance.uniform(3, 12), chance.uniform(3, 6)
        points = b""
        for beam in range(48):
            angle = 2 * math.pi * beam / 48
            reach = min(width / 2 / max(abs(math.cos(angle)), 1e-6), depth / 2 / max(abs(math.sin(angle)), 1e-6))
            points += struct.pack("<2f", reach * math.cos(angle), reach * math.sin(angle))
        made.append(packed(points, 1, 48, 13))
    return made


def places(plan, signatures):
    """Zone by zone, as a robot that maps one after the other: (x, y, yaw)."""
    chance = random.Random(1)
    for i, (_, _, (x0, y0, x1, y1)) in enumerate(plan.zones):
        count = signatures * (i + 1) // len(plan.zones) - signatures * i // len(plan.zones)
        for _ in range(count):
            yield (chance.uniform(x0 + 0.3, x1 - 0.3), chance.uniform(y0 + 0.3, y1 - 0.3),
                   chance.uniform(-math.pi, math.pi))


def write_database(plan, signatures, path):
    with open(path, "wb"):
        pass
    database = sqlite3.connect(path)
    database.executescript("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF;" + SCHEMA)
    made = scans(random.Random(2))
    info = struct.pack("<19f", 1, 0.1, 12, -math.pi, math.pi, 2 * math.pi / 48, 48, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.2)
    information = struct.pack("<36d", *(100.0 if i % 7 == 0 else 0.0 for i in range(36)))
    step = pose(1, 0, 0)
    ids, poses = bytearray(), bytearray()
    with database:
        database.execute("INSERT INTO Info(parameters) VALUES('Kp/DetectorStrategy:8')")
        for i, (x, y, yaw) in enumerate(places(plan, signatures), start=1):
            T_map_base = pose(x, y, yaw)
            ids += struct.pack("<i", i)
            poses += T_map_base
            database.execute("INSERT INTO Node(id, map_id, weight, stamp, pose) VALUES(?, 0, 0, ?, ?)",
                             (i, 1.7e9 + i, T_map_base))
            database.execute("INSERT INTO Data(id, scan, scan_info) VALUES(?, ?, ?)", (i, made[i % SCANS], info))
            if i > 1:
                database.execute("INSERT INTO Link VALUES(?, ?, 0, ?, ?, NULL)", (i, i - 1, information, step))
        database.execute("CREATE INDEX IDX_Link_from_id ON Link (from_id)")
        database.execute("CREATE INDEX IDX_Feature_node_id ON Feature (node_id)")
        database.execute("CREATE UNIQUE INDEX IDX_node_label ON Node (label)")
        database.execute("INSERT INTO Admin(version, opt_ids, opt_poses) VALUES('0.23.8', ?, ?)",
                         (packed(bytes(ids), 1, len(ids) // 4, 4), packed(bytes(poses), 1, len(poses) // 4, 5)))
    database.close()


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    plan = Plan(int(sys.argv[1]))
    write_zones(plan, sys.argv[4])
    write_database(plan, int(sys.argv[2]), sys.argv[3])


main()
