#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the features of an RTAB-Map database as a map of stella_vslam, byte by byte.

usage: stella_map.py DB OUT (msgpack|msgpack2019|sqlite) [--scale UNITS_PER_METRE] [--setup Monocular|RGBD]
                     [--trajectory OUT.txt] [--keyframes N]

World is the first keyframe's camera, as stella_vslam leaves it. Each feature with a point is a keypoint with a landmark of
its own. --trajectory writes where the robot's base was (TUM), for `zonepack build --align`.
"""
import argparse
import math
import os
import sqlite3
import struct
import zlib

ORB = "default ORB feature extraction setting"


def multiply(a, b):
    """Of two 4x4 matrices, lists of rows."""
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(m):
    r = [[m[j][i] for j in range(3)] for i in range(3)]
    t = [-sum(r[i][k] * m[k][3] for k in range(3)) for i in range(3)]
    return [r[0] + [t[0]], r[1] + [t[1]], r[2] + [t[2]], [0, 0, 0, 1]]


def matrix(twelve):
    return [list(twelve[0:4]), list(twelve[4:8]), list(twelve[8:12]), [0, 0, 0, 1]]


def place(m, p):
    return [sum(m[i][k] * p[k] for k in range(3)) + m[i][3] for i in range(3)]


def quaternion(m):
    """x, y, z, w of the rotation."""
    trace = m[0][0] + m[1][1] + m[2][2]
    options = [1 + 2 * m[0][0] - trace, 1 + 2 * m[1][1] - trace, 1 + 2 * m[2][2] - trace, 1 + trace]
    most = max(range(4), key=lambda i: options[i])
    s = 2 * math.sqrt(options[most])
    a, b, c = m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]
    d, e, f = m[0][1] + m[1][0], m[0][2] + m[2][0], m[1][2] + m[2][1]
    q = [[0, d, e, a], [d, 0, f, b], [e, f, 0, c], [a, b, c, 0]][most]
    q = [value / s for value in q]
    q[most] = s / 4
    return q


def uncompressed(blob, kind):
    data = zlib.decompress(blob[:-12])
    return struct.unpack(f"<{len(data) // 4}{kind}", data)


def read_rtabmap(path, most):
    """Of each signature with an optimised pose: id, stamp, T_map_base, features (rows of the table)."""
    db = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    ids, poses = db.execute("SELECT opt_ids, opt_poses FROM Admin WHERE version IS NOT NULL").fetchone()
    ids, poses = uncompressed(ids, "i"), uncompressed(poses, "f")
    signatures, camera = [], None
    for i, node in sorted((node, i) for i, node in enumerate(ids) if node > 0):
        row = db.execute("SELECT stamp FROM Node WHERE id=?", (i,)).fetchone()
        calibration = db.execute("SELECT calibration FROM Data WHERE id=?", (i,)).fetchone()
        if row is None or calibration is None or len(signatures) == most:
            continue
        features = db.execute("SELECT pos_x, pos_y, size, dir, response, octave, depth_x, depth_y, depth_z, descriptor"
                              " FROM Feature WHERE node_id=? ORDER BY rowid", (i,)).fetchall()
        if camera is None:
            head = struct.unpack_from("<11i", calibration[0])
            k = struct.unpack_from("<9d", calibration[0], 44)
            mount = struct.unpack_from("<12f", calibration[0], 44 + 8 * sum(head[6:10]))
            camera = {"cols": head[4], "rows": head[5], "fx": k[0], "fy": k[4], "cx": k[2], "cy": k[5],
                      "T_base_camera": matrix(mount)}
        signatures.append((i, row[0], matrix(poses[12 * node:12 * node + 12]), features))
    return signatures, camera


def pack(value):
    """MessagePack of dictionaries, lists, texts, whole numbers and floats."""
    if isinstance(value, dict):
        head = bytes([0x80 | len(value)]) if len(value) < 16 else b"\xdf" + struct.pack(">I", len(value))
        return head + b"".join(pack(str(key)) + pack(value[key]) for key in sorted(value, key=str))
    if isinstance(value, list):
        head = bytes([0x90 | len(value)]) if len(value) < 16 else b"\xdd" + struct.pack(">I", len(value))
        return head + b"".join(map(pack, value))
    if isinstance(value, str):
        text = value.encode()
        return (bytes([0xa0 | len(text)]) if len(text) < 32 else b"\xdb" + struct.pack(">I", len(text))) + text
    if isinstance(value, int):
        if -32 <= value < 128:
            return struct.pack("b", value)
        return b"\xce" + struct.pack(">I", value) if value >= 0 else b"\xd2" + struct.pack(">i", value)
    single = struct.unpack("f", struct.pack("f", value))[0]
    return b"\xca" + struct.pack(">f", value) if single == value else b"\xcb" + struct.pack(">d", value)


class StellaMap:
    def __init__(self, signatures, camera, scale, setup):
        self.camera, self.setup = camera, setup
        mount = camera["T_base_camera"]
        world = multiply(signatures[0][2], mount)
        self.keyframes, self.landmarks, self.trajectory = [], [], []
        for at, (number, stamp, T_map_base, features) in enumerate(signatures):
            T_world_camera = multiply(inverse(world), multiply(T_map_base, mount))
            for row in range(3):
                T_world_camera[row][3] *= scale
            landmark_ids = []
            for feature in features:
                if None in feature[6:9] or not all(map(math.isfinite, feature[6:9])):
                    landmark_ids.append(-1)
                    continue
                p = place(inverse(world), place(T_map_base, feature[6:9]))
                landmark_ids.append(len(self.landmarks))
                self.landmarks.append(([x * scale for x in p], number))
            self.keyframes.append({"id": number, "ts": stamp, "T_cw": inverse(T_world_camera), "features": features,
                                   "lm_ids": landmark_ids, "parent": signatures[at - 1][0] if at else None,
                                   "children": [signatures[at + 1][0]] if at + 1 < len(signatures) else [],
                                   "loops": [signatures[0][0]] if at == len(signatures) - 1 and at > 1 else []})
            self.trajectory.append((stamp, [row[3] for row in T_map_base[:3]], quaternion(T_map_base)))

    def stored_camera(self):
        c = self.camera
        return {"setup_type": self.setup, "model_type": "Perspective", "color_order": "RGB", "cols": c["cols"],
                "rows": c["rows"], "fps": 30.0, "fx": c["fx"], "fy": c["fy"], "cx": c["cx"], "cy": c["cy"], "k1": 0.0,
                "k2": 0.0, "p1": 0.0, "p2": 0.0, "k3": 0.0, "focal_x_baseline": 0.0, "num_grid_cols": 64,
                "num_grid_rows": 48}

    def write_msgpack(self, path, of_2019):
        keyframes = {}
        for k in self.keyframes:
            one = {"ts": k["ts"], "cam": "camera", "rot_cw": quaternion(k["T_cw"]),
                   "trans_cw": [row[3] for row in k["T_cw"][:3]], "n_keypts": len(k["features"]), "x_rights": [],
                   "depths": [], "descs": [list(struct.unpack("<8I", f[9])) for f in k["features"]],
                   "lm_ids": k["lm_ids"], "span_children": k["children"], "loop_edges": k["loops"],
                   "span_parent": (-1 if of_2019 else 4294967295) if k["parent"] is None else k["parent"]}
            points = [{"pt": [f[0], f[1]], "ang": f[3], "oct": f[5]} for f in k["features"]]
            if of_2019:
                one.update(src_frm_id=k["id"], depth_thr=40.0, n_scale_levels=8, scale_factor=1.2, keypts=points,
                           undists=[[f[0], f[1]] for f in k["features"]])
            else:
                one.update(undist_keypts=points, orb_params=ORB)
            keyframes[k["id"]] = one
        whole = {"cameras": {"camera": self.stored_camera()}, "keyframes": keyframes,
                 "landmarks": {i: {"1st_keyfrm": first, "pos_w": p, "ref_keyfrm": first, "n_vis": 1, "n_fnd": 1}
                               for i, (p, first) in enumerate(self.landmarks)},
                 "keyframe_next_id": self.keyframes[-1]["id"] + 1, "landmark_next_id": len(self.landmarks)}
        if of_2019:
            whole["frame_next_id"] = 1000
        else:
            whole["orb_params"] = {ORB: {"name": ORB, "scale_factor": 1.2000000476837158, "num_levels": 8,
                                         "ini_fast_threshold": 20, "min_fast_threshold": 7}}
        with open(path, "wb") as out:
            out.write(pack(whole))

    def write_sqlite(self, path):
        if os.path.exists(path):
            os.remove(path)
        db = sqlite3.connect(path)
        db.executescript("""
            CREATE TABLE cameras(id INTEGER PRIMARY KEY, name BLOB, setup_type BLOB, model_type BLOB, color_type BLOB,
              cols INTEGER, rows INTEGER, fps REAL, fx REAL, fy REAL, cx REAL, cy REAL, k1 REAL, k2 REAL, p1 REAL, p2 REAL,
              k3 REAL, k4 REAL, focal_x_baseline REAL, distortion REAL);
            CREATE TABLE keyframes(id INTEGER PRIMARY KEY, src_frm_id INTEGER, ts REAL, cam BLOB, orb_params BLOB,
              pose_cw BLOB, n_keypts INTEGER, undist_keypts BLOB, x_rights BLOB, depths BLOB, descs BLOB,
              n_markers INTEGER, markers BLOB);
            CREATE TABLE landmarks(id INTEGER PRIMARY KEY, first_keyfrm INTEGER, pos_w BLOB, ref_keyfrm INTEGER,
              n_vis INTEGER, n_fnd INTEGER);
            CREATE TABLE associations(id INTEGER PRIMARY KEY, lm_ids BLOB, span_parent INTEGER,
              n_spanning_children INTEGER, spanning_children BLOB, n_loop_edges INTEGER, loop_edges BLOB);
            CREATE TABLE stats(id INTEGER PRIMARY KEY, frame_next_id INTEGER, keyframe_next_id INTEGER,
              landmark_next_id INTEGER);""")
        c = self.stored_camera()
        db.execute("INSERT INTO cameras VALUES(0,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
                   (b"camera", self.setup.encode(), b"Perspective", b"RGB", c["cols"], c["rows"], 30.0, c["fx"], c["fy"],
                    c["cx"], c["cy"], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
        ids = lambda values: struct.pack(f"<{len(values)}i", *values)
        for k in self.keyframes:
            keypoints = b"".join(struct.pack("<5f2i", f[0], f[1], f[2], f[3], f[4], f[5], -1) for f in k["features"])
            pose = struct.pack("<16d", *(k["T_cw"][i % 4][i // 4] for i in range(16)))
            db.execute("INSERT INTO keyframes VALUES(?,?,?,?,?,?,?,?,NULL,NULL,?,0,NULL)",
                       (k["id"], k["id"], k["ts"], b"camera", ORB.encode(), pose, len(k["features"]), keypoints,
                        b"".join(f[9] for f in k["features"])))
            db.execute("INSERT INTO associations VALUES(?,?,?,?,?,?,?)",
                       (k["id"], ids(k["lm_ids"]), -1 if k["parent"] is None else k["parent"], len(k["children"]),
                        ids(k["children"]), len(k["loops"]), ids(k["loops"])))
        for i, (p, first) in enumerate(self.landmarks):
            db.execute("INSERT INTO landmarks VALUES(?,?,?,?,1,1)", (i, first, struct.pack("<3d", *p), first))
        db.execute("INSERT INTO stats VALUES(0,1000,?,?)", (self.keyframes[-1]["id"] + 1, len(self.landmarks)))
        db.commit()
        db.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("db")
    parser.add_argument("out")
    parser.add_argument("format", choices=["msgpack", "msgpack2019", "sqlite"])
    parser.add_argument("--scale", type=float, default=1.0)
    parser.add_argument("--setup", default="RGBD")
    parser.add_argument("--trajectory")
    parser.add_argument("--keyframes", type=int, default=10**9)
    options = parser.parse_args()
    made = StellaMap(*read_rtabmap(options.db, options.keyframes), options.scale, options.setup)
    if options.format == "sqlite":
        made.write_sqlite(options.out)
    else:
        made.write_msgpack(options.out, options.format == "msgpack2019")
    if options.trajectory:
        with open(options.trajectory, "w", encoding="ascii") as out:
            for stamp, p, q in made.trajectory:
                out.write(f"{stamp:.9f} " + " ".join(f"{value:.9f}" for value in p + q) + "\n")


if __name__ == "__main__":
    main()
