#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: stella_test.py BIN SOURCE: maps of stella_vslam, made of the sample database's own features.

All three forms of the file give the same keyframes, bit for bit what the file holds; zoneloc finds the same poses in them
as in the RTAB-Map database; then every kind of bad input, each refused by name with exit code 1.
"""
import base64
import json
import math
import sqlite3
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from source_tools import BIN, DATABASE, SOURCE, ZONES, build, check_memory, need, refused, zonepack

sys.path.insert(0, str(SOURCE / "tests/support"))
import stella_map  # noqa: E402

MISSION = SOURCE / "tests/data/scenario1_loop"
SCALE = 0.37  # units of a metre, as a map of one camera may have
IMAGES = (10, 60, 110, 160, 210)


def exported(folder):
    lines = zonepack("export", folder).stdout.splitlines()
    return {line["keyframe"]: line for line in map(json.loads, lines)}


def forms(work):
    """The three forms of one map, packed, and what went into them."""
    signatures, camera = stella_map.read_rtabmap(DATABASE, 10**9)
    made = stella_map.StellaMap(signatures, camera, SCALE, "Monocular")
    made.write_msgpack(work / "map.msg", False)
    made.write_msgpack(work / "map2019.msg", True)
    made.write_sqlite(work / "map.db")
    with open(work / "base.txt", "w", encoding="ascii") as out:
        for stamp, p, q in made.trajectory:
            out.write(f"{stamp:.9f} " + " ".join(f"{value:.9f}" for value in p + q) + "\n")
    detector = sqlite3.connect(DATABASE).execute("SELECT parameters FROM Info").fetchone()[0]
    wanted = [entry for entry in detector.split(";") if entry.startswith(("GFTT/", "ORB/")) and "Gpu" not in entry]
    most = [entry for entry in detector.split(";") if entry.startswith("Kp/MaxFeatures:")]
    place = ("--align", work / "base.txt", "--camera-in-base", "0.2,0,0.5,0,0,0", "--detector",
             "8 " + ";".join(most + wanted))
    for name in ("map.msg", "map2019.msg", "map.db"):
        done = build(work / name, work / f"packed-{name}", *place)
        need("185 of 185 keyframes, 1 unit is 2.70" in done.stderr, f"{name}: {done.stderr}")
        zonepack("verify", work / f"packed-{name}")
    return made, place


def check_forms(work, made):
    """What is exported is what the file holds, read back by sqlite3."""
    of = {name: exported(work / f"packed-{name}") for name in ("map.msg", "map2019.msg", "map.db")}
    database = sqlite3.connect(work / "map.db")
    need(len(of["map.db"]) == len(made.keyframes), "keyframes are missing")
    for number, count, keypoints, descs, lm_ids, parent, loops in database.execute(
            "SELECT k.id, n_keypts, undist_keypts, descs, lm_ids, span_parent, loop_edges FROM keyframes k"
            " JOIN associations a ON a.id = k.id"):
        one = of["map.db"][number]
        stored = [list(row[:6]) for row in struct.iter_unpack("<5f2i", keypoints)]
        need(len(one["undist_keypts"]) == count and one["undist_keypts"] == stored, f"keyframe {number}: keypoints")
        need(base64.b64decode(one["descs"]) == descs, f"keyframe {number}: descriptors")
        need(one["lm_ids"] == list(struct.unpack(f"<{count}i", lm_ids)), f"keyframe {number}: landmarks")
        need(one["span_parent"] == parent, f"keyframe {number}: parent")
        need(one["loop_edges"] == list(struct.unpack(f"<{len(loops) // 4}i", loops)), f"keyframe {number}: loop edges")
        for name in ("map.msg", "map2019.msg"):
            other = of[name][number]
            for key in ("lm_ids", "descs", "span_parent", "loop_edges", "calibration", "ts"):
                need(other[key] == one[key], f"{name}, keyframe {number}: {key} is not map.db's")
            need([p[:2] + [p[3], p[5]] for p in other["undist_keypts"]] ==
                 [p[:2] + [p[3], p[5]] for p in stored], f"{name}, keyframe {number}: keypoints")
            need(max(abs(a - b) for a, b in zip(other["pose"], one["pose"])) < 1e-5, f"{name}, keyframe {number}: pose")
    signatures = {s[0]: s for s in stella_map.read_rtabmap(DATABASE, 10**9)[0]}
    for number, one in of["map.db"].items():
        _, _, T_map_base, features = signatures[number]
        need(math.dist([one["pose"][i] for i in (3, 7, 11)], [row[3] for row in T_map_base[:3]]) < 1e-3,
             f"keyframe {number} is not where the signature is")
        for point, feature in zip(one["points"], features):
            need(point is None or math.dist(point, feature[6:9]) < 1e-3, f"keyframe {number}: a point has moved")


def check_by_msgpack(work, made):
    """The file that the test wrote, read by somebody else's reader."""
    try:
        import msgpack
    except ImportError:
        print("not run: MessagePack read by python3-msgpack, which is not installed")
        return
    with open(work / "map.msg", "rb") as file:
        whole = msgpack.unpackb(file.read(), strict_map_key=False)
    need(len(whole["keyframes"]) == len(made.keyframes) and len(whole["landmarks"]) == len(made.landmarks),
         "python3-msgpack reads another map than was written")


def truth_at(stamp):
    best = None
    for line in (MISSION / "base_groundtruth.txt").read_text().splitlines():
        if line.startswith("#") or not line.strip():
            continue
        v = [float(word) for word in line.split()]
        if best is None or abs(v[0] - stamp) < abs(best[0] - stamp):
            best = v
    return best[1], best[2], math.degrees(2 * math.atan2(best[6], best[7]))


def check_fixes(work):
    """The same images find the same poses, by the same evidence."""
    if not (BIN / "zoneloc").exists():
        print("not run: fixes in a map of stella_vslam; zoneloc is not built here")
        return
    build(DATABASE, work / "packed-rtabmap")
    images = [line.split() for line in (MISSION / "rgb.txt").read_text().splitlines() if not line.startswith("#")]
    found = 0
    for at in IMAGES:
        stamp, name = images[at][:2]
        near = "{:.3f},{:.3f},{:.2f}".format(*truth_at(float(stamp)))
        answers = []
        for packed in ("packed-rtabmap", "packed-map.msg", "packed-map.db"):
            done = subprocess.run([BIN / "zoneloc", "query", "--map", work / packed, "--image", MISSION / name,
                                   "--calibration", MISSION / "calibration.yaml", f"--near={near}", "--json", "-"],
                                  capture_output=True, text=True, check=False, timeout=60)
            need(done.returncode in (0, 1) and done.stdout, f"zoneloc query in {packed}: {done.stderr}")
            answers.append(json.loads(done.stdout))
        ours = [(a.get("pose"), a.get("inliers")) for a in answers]
        if ours[0][0] is None:
            need(ours[1][0] is None and ours[2][0] is None, f"image {at}: a pose in one map only: {ours}")
            continue
        found += 1
        here = ours[0][0]
        for pose, _ in ours[1:]:
            need(math.hypot(pose["x_m"] - here["x_m"], pose["y_m"] - here["y_m"]) < 0.005 and
                 abs(pose["yaw_deg"] - here["yaw_deg"]) < 0.1, f"image {at}: {ours}")
    need(found >= 3, f"only {found} of {len(IMAGES)} images were found, which shows nothing")


def check_bad_msgpack(work):
    good = (work / "map.msg").read_bytes()
    pack = stella_map.pack
    for share in (0.001, 0.3, 0.7, 0.999):
        refused(work, "cut.msg", good[:int(len(good) * share)], "not whole or not MessagePack")
    refused(work, "trailing.msg", good + b"\x00", "not MessagePack")
    refused(work, "deep.msg", b"\x81\xa9keyframes" + b"\x91" * 2_000_000, "at most 8 levels")
    refused(work, "lying.msg", b"\x81\xa9keyframes\xdf\xff\xff\xff\xff", "not whole")
    refused(work, "long_text.msg", b"\x81\xa9keyframes\xdb\xff\xff\xff\xff", "not whole")
    refused(work, "list.msg", pack({"keyframes": [1]}), "cameras, keyframes and landmarks")
    camera = {"c": {"setup_type": "RGBD", "model_type": "Perspective", "cols": 4, "rows": 3, "fx": 1.0, "fy": 1.0,
                    "cx": 2.0, "cy": 1.0}}
    def one(**other):
        keyframe = {"ts": 1.0, "cam": "c", "rot_cw": [0.0, 0.0, 0.0, 1.0], "trans_cw": [0.0, 0.0, 0.0], "n_keypts": 1,
                    "undist_keypts": [{"pt": [1.0, 1.0], "ang": 0.0, "oct": 0}], "descs": [[1] * 8], "lm_ids": [0],
                    "x_rights": [], "depths": [], "span_parent": 4294967295, "span_children": [], "loop_edges": []}
        keyframe.update(other)
        return pack({"cameras": camera, "landmarks": {"0": {"pos_w": [0.0, 0.0, 1.0]}},
                     "keyframes": {"7": {k: v for k, v in keyframe.items() if v is not None}}})
    zone = ("--orphans", "nearest")
    (work / "one.msg").write_bytes(one())
    build(work / "one.msg", work / "one", *zone)
    for name, content, said in (
            ("nan.msg", one(trans_cw=[0.0, math.nan, 0.0]), "signature 7, trans_cw: expected a place"),
            ("far.msg", one(trans_cw=[0.0, 1e30, 0.0]), "signature 7, trans_cw: expected a place"),
            ("unturned.msg", one(rot_cw=[0.0, 0.0, 0.0, 0.0]), "rot_cw: expected a rotation"),
            ("short.msg", one(descs=[[1] * 7]), "descs: expected 1"),
            ("odd.msg", one(descs=[[-1] * 8]), "descs: expected 8 numbers of 32 bits"),
            ("many.msg", one(n_keypts=2), "expected 2, as n_keypts says, found 1"),
            ("count.msg", one(n_keypts=4000000000), "n_keypts: expected 0 to 1000000"),
            ("bare.msg", one(cam=None), "keyframe 7: expected ts, cam")):
        refused(work, name, content, said, options=zone)
    twice = one().replace(b"\x81\xa17", b"\x81\xa3abc")
    refused(work, "named.msg", twice, "holds the id 'abc'")
    refused(work, "empty.msg", pack({"cameras": camera, "landmarks": {}, "keyframes": {}}), "holds no signatures")


def check_bad_sqlite(work):
    def changed(name, sql, *said, options=()):
        (work / name).write_bytes((work / "map.db").read_bytes())
        with sqlite3.connect(work / name) as database:
            database.executescript(sql)
        database.close()
        refused(work, name, None, *said, options=options)
    changed("no_table.db", "DROP TABLE landmarks", "without its table landmarks", "save the map again")
    changed("no_keyframes.db", "DROP TABLE keyframes", "without its table keyframes")
    changed("short.db", "UPDATE keyframes SET undist_keypts = x'00' WHERE id = 9", "signature 9, keyframes.undist_keypts")
    changed("counts.db", "UPDATE keyframes SET n_keypts = 999999 WHERE id = 9", "signature 9", "expected 999999")
    changed("huge.db", "UPDATE keyframes SET n_keypts = 2000000000 WHERE id = 9", "signature 9, keyframes.n_keypts")
    changed("pose.db", "UPDATE keyframes SET pose_cw = zeroblob(128) WHERE id = 9", "keyframes.pose_cw: expected a rotation")
    changed("ids.db", "UPDATE associations SET lm_ids = NULL WHERE id = 9", "signature 9, associations.lm_ids")
    changed("view.db", "ALTER TABLE landmarks RENAME TO l; CREATE VIEW landmarks AS SELECT * FROM l",
            "landmarks is a view")
    changed("none.db", "DELETE FROM keyframes", "holds no signatures")
    done = build(work / "short.db", work / "skipped", "--damaged", "skip")
    need("signature 9 left out" in done.stderr, done.stderr)


def check_places(work):
    far = "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 1 1 0 0 0 0 1\n"
    (work / "far.txt").write_text(far)
    done = build(work / "map.msg", work / "never", "--align", work / "far.txt", code=1)
    need("covers 0 of the 185 keyframes" in done.stderr, done.stderr)
    for wrong in (("--scale", "0"), ("--up", "0,0,0"), ("--up", "1,2"), ("--camera-in-base", "1,2,3"),
                  ("--camera-in-base", "0,0,0,0,0,nan"), ("--from", "cartographer"),
                  ("--scale", "2", "--align", work / "base.txt")):
        build(work / "map.msg", work / "never", *wrong, code=2)
    done = build(work / "map.msg", work / "unplaced", "--scale", 1 / SCALE)
    need("no zone" in done.stderr, "a map that begins at its first keyframe fits the drawing")
    done = build(work / "map.db", work / "never", "--from", "rtabmap", code=1)
    need("is not an RTAB-Map database" in done.stderr, done.stderr)
    zonepack("outline", "--db", work / "map.msg", "--align", work / "base.txt", "--out", work / "outline")
    zonepack("check-zones", ZONES, "--db", work / "map.db", "--align", work / "base.txt")


def check_others(work):
    archive = b"\x16\0\0\0\0\0\0\0serialization::archive\x11\0\x04\x08" + b"\0" * 40
    for name, content, said in (
            ("atlas.osa", archive + b"ORBvoc.txt", "ORB-SLAM3"),
            ("map.posegraph", archive, "slam_toolbox"),
            ("map.pbstream", b"\xdb\x01\xf5\x5b\x7b\x1f\x1d\x7b" + b"\0" * 40, "Cartographer"),
            ("data.mdb", b"\0" * 16 + b"\xde\xc0\xef\xbe" + b"\0" * 100, "cuVSLAM"),
            ("link.db", b"../maps/building.db\n", "the path '../maps/building.db'"),
            ("pointer.msg", b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 4\n", "git lfs pull")):
        refused(work, name, content, said)
    (work / "cuvslam").mkdir()
    (work / "cuvslam" / "data.mdb").write_bytes(b"\0" * 16 + b"\xde\xc0\xef\xbe" + b"\0" * 100)
    done = build(work / "cuvslam", work / "never", code=1)
    need("cuVSLAM" in done.stderr, done.stderr)


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        made, _ = forms(work)
        check_by_msgpack(work, made)
        check_forms(work, made)
        check_fixes(work)
        check_bad_msgpack(work)
        check_bad_sqlite(work)
        check_places(work)
        check_others(work)
    check_memory()
    print("stella_test: all forms hold the same map, and bad ones are refused by name")


if __name__ == "__main__":
    main()
