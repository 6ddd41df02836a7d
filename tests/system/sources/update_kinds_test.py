#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: update_kinds_test.py BIN SOURCE: maps of stella_vslam and clouds, updated with what was mapped later.

What an update does not name stays byte for byte, what it takes is what a build of everything has there, the same update
again changes nothing, and what a kind cannot do is refused by name.
"""
import json
import math
import shutil
import sys
import tempfile
from pathlib import Path

from source_tools import DATABASE, SOURCE, ZONES, build, check_memory, need, zonepack

sys.path.insert(0, str(SOURCE / "tests/support"))
import hospital_cloud as clouds  # noqa: E402
import stella_map  # noqa: E402

EARLIER = 92  # signatures of the first session
LATER = 1e6  # seconds: another recording


def update(folder, *options):
    done = zonepack("update", folder, *options, "--json", folder.parent / "update.json")
    zonepack("verify", folder)
    return json.loads((folder.parent / "update.json").read_text()), done.stderr


def refused(folder, said, *options, code=1):
    before = packs_of(folder)
    done = zonepack("update", folder, *options, code=code)
    need(said in done.stderr, f"expected '{said}' in: {done.stderr}")
    need(packs_of(folder) == before, f"{options} changed the map")


def packs_of(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def zones_of(folder):
    """The pack of each zone."""
    inspected = json.loads(zonepack("inspect", folder, "--json", "-").stdout)
    return {zone["name"]: zone["pack"] for zone in inspected["zones"]}


def exported(folder, key, zone=None):
    lines = zonepack("export", folder, *(("--zone", zone) if zone else ())).stdout.splitlines()
    return {line[key]: line for line in map(json.loads, lines)}


def points_of(folder, zone=None):
    return sorted(tuple(p) for tile in exported(folder, "tile", zone).values() for p in tile["points"])


def without_zone(work, name):
    """A zone file that lacks a zone and its portals."""
    drawing = json.loads(ZONES.read_text())
    drawing["features"] = [f for f in drawing["features"] if f["properties"].get("name") != name
                           and name not in f["properties"].get("zones", [])]
    path = work / f"without-{name}.geojson"
    path.write_text(json.dumps(drawing))
    return path


def only_changed(base, folder, *names):
    before, after = zones_of(base), zones_of(folder)
    changed = {name for name in before if after.get(name) != before[name]}
    need(changed == set(names), f"changed {changed}, not {set(names)}")
    kept = packs_of(folder)
    for name, content in packs_of(base).items():
        need(not name.endswith(".zpk") or kept[name] == content, f"{name} is another than before")


def fresh(base, name):
    folder = base.parent / name
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(base, folder)
    return folder


def stella_maps(work):
    """The same map as it was earlier, as it is, and one of another recording."""
    signatures, camera = stella_map.read_rtabmap(DATABASE, 10**9)
    other = [(number, stamp + LATER, pose, features) for number, stamp, pose, features in signatures[40:150]]
    for name, part in (("earlier", signatures[:EARLIER]), ("now", signatures), ("other", other)):
        made = stella_map.StellaMap(part, camera, 0.37, "Monocular")
        if name == "earlier":
            made.keyframes[-1]["loops"] = []  # the loop was closed later
        made.write_msgpack(work / f"{name}.msg", False)
        made.write_sqlite(work / f"{name}-sqlite.db")
        with open(work / f"{name}.txt", "w", encoding="ascii") as out:
            for stamp, p, q in made.trajectory:
                out.write(f"{stamp:.9f} " + " ".join(f"{value:.9f}" for value in p + q) + "\n")


def placed(work, file, name):
    return "--db", work / file, "--align", work / f"{name}.txt", "--camera-in-base", "0.2,0,0.5,0,0,0"


def check_stella(work):
    stella_maps(work)
    ids = {}
    for form in ("msg", "db"):
        earlier, now, other = (f"{name}{'.msg' if form == 'msg' else '-sqlite.db'}" for name in ("earlier", "now", "other"))
        base = work / f"stella-{form}"
        build(work / earlier, base, *placed(work, earlier, "earlier")[2:])
        build(work / now, work / f"full-{form}", *placed(work, now, "now")[2:])
        full = exported(work / f"full-{form}", "keyframe")
        folder = fresh(base, "map")
        said, _ = update(folder, *placed(work, now, "now"), "--add")
        need((said["signatures"], said["signatures_added"], said["ids_mapped"]) == (len(full), len(full) - EARLIER, []),
             f"{form}: {said}")
        added = exported(folder, "keyframe")
        need({k: v["zone"] for k, v in added.items()} == {k: v["zone"] for k, v in full.items()}, f"{form}: other zones")
        for number, one in added.items():
            for key in ("ts", "undist_keypts", "descs", "lm_ids", "span_parent", "loop_edges"):
                need(one[key] == full[number][key], f"{form}, keyframe {number}: {key} is not as a build has it")
            need(math.dist(one["pose"], full[number]["pose"]) < 1e-3, f"{form}, keyframe {number}: pose")
        need(update(folder, *placed(work, now, "now"), "--add")[0]["unchanged"], f"{form}: changed again")
        ids[form] = {k: v["descs"] for k, v in added.items()}
        # One zone.
        folder = fresh(base, "map")
        said, _ = update(folder, *placed(work, now, "now"), "--replace", "C2")
        need(said["zones_changed"] == ["C2"], f"{form}: {said}")
        only_changed(base, folder, "C2")
        # Another recording: its ids clash, and are found again.
        said, _ = update(folder, *placed(work, other, "other"), "--replace", "C2")
        need(said["ids_mapped"] and all(pair["to"] > EARLIER for pair in said["ids_mapped"]), f"{form}: {said['ids_mapped']}")
        need({v["ts"] > LATER for v in exported(folder, "keyframe", "C2").values()} == {True}, f"{form}: C2 holds others too")
        again = update(folder, *placed(work, other, "other"), "--replace", "C2")[0]
        need(again["unchanged"], f"{form}: other ids: {said} {again}")
        # A zone that the map lacks.
        folder = work / "map"
        shutil.rmtree(folder)
        zonepack("build", *placed(work, now, "now"), "--zones", without_zone(work, "R51"), "--out", folder, "--orphans", "drop")
        before = fresh(folder, "before")
        said, _ = update(folder, *placed(work, now, "now"), "--zones", ZONES, "--add")
        need(said["zones_added"] == ["R51"] and said["zones_changed"] == [], f"{form}: {said}")
        only_changed(before, folder)
    need(ids["msg"] == ids["db"], "MessagePack and SQLite give other keyframes")
    folder = fresh(work / "stella-msg", "map")
    said, _ = update(folder, *placed(work, "now-sqlite.db", "now"), "--add")  # the same map, saved otherwise
    need(said["signatures_shared"] == EARLIER and said["ids_mapped"] == [], f"{said}")
    refused(folder, "is a source of kind rtabmap, and the map", "--db", DATABASE, "--add")


def check_pcd(work, earlier, points):
    clouds.write_pcd(work / "earlier.pcd", earlier, "binary")
    clouds.write_pcd(work / "now.pcd", points, "binary_compressed")
    base, full = work / "pcd", work / "full-pcd"
    build(work / "earlier.pcd", base)
    build(work / "now.pcd", full)
    folder = fresh(base, "map")
    said, _ = update(folder, "--db", work / "now.pcd", "--replace", "C2")
    need(said["zones_changed"] == ["C2"], f"{said}")
    only_changed(base, folder, "C2")
    need(points_of(folder, "C2") == points_of(full, "C2"), "C2 is not as a build has it")
    need(points_of(folder, "L1") == points_of(base, "L1"), "L1 is not as it was")
    need(update(folder, "--db", work / "now.pcd", "--replace", "C2")[0]["unchanged"], "pcd: changed again")
    every = list(zones_of(folder))
    update(folder, "--db", work / "now.pcd", "--replace", *every)
    need(points_of(folder) == sorted(points), "pcd: all zones replaced are not the whole cloud")
    refused(folder, "name the zones to take from it with --replace ZONE", "--db", work / "now.pcd", "--add")
    shutil.rmtree(folder)
    zonepack("build", "--db", work / "now.pcd", "--zones", without_zone(work, "R51"), "--out", folder, "--orphans", "drop")
    before = fresh(folder, "before")
    said, _ = update(folder, "--db", work / "now.pcd", "--zones", ZONES, "--add")
    need(said["zones_added"] == ["R51"] and said["zones_changed"] == [], f"{said}")
    only_changed(before, folder)
    build(work / "now.pcd", full, "--orphans", "drop")  # as the map was packed
    need(points_of(folder, "R51") == points_of(full, "R51"), "R51 is not as a build has it")


def check_autoware(work, points):
    """A tile is its file, whatever its number."""
    now, earlier = work / "autoware", work / "autoware-earlier"
    clouds.write_autoware(now, points, 5)
    shutil.copytree(now, earlier)
    gone = sorted(path.name for path in now.glob("tile_*.pcd"))[3:6]
    listing = earlier / "pointcloud_map_metadata.yaml"
    listing.write_text("".join(line for line in listing.read_text().splitlines(True) if line.split(":")[0] not in gone))
    for name in gone:
        (earlier / name).unlink()
    base, full = work / "tiles", work / "full-tiles"
    build(earlier, base)
    build(now, full)
    folder = fresh(base, "map")
    said, _ = update(folder, "--db", now, "--add")
    need(said["signatures_added"] == len(gone) and said["signatures_removed"] == 0, f"{said}")
    expected = {name: sorted(map(tuple, tile["points"])) for name, tile in exported(full, "file").items()}
    found = {name: sorted(map(tuple, tile["points"])) for name, tile in exported(folder, "file").items()}
    need(found == expected, "autoware: tiles are not as a build has them")
    need(update(folder, "--db", now, "--add")[0]["unchanged"], "autoware: changed again")
    # The zone that holds the fullest tile, of which half the points are gone.
    name, tile = max(exported(full, "file").items(), key=lambda item: len(item[1]["points"]))
    kept = [p for p in tile["points"]][::2]
    (now / name).write_bytes(clouds.header(len(kept), "binary") + b"".join(clouds.record((*p[:4], p[4], int(p[5]))) for p in kept))
    before = fresh(folder, "before")
    said, _ = update(folder, "--db", now, "--replace", tile["zone"])
    need(said["zones_changed"] == [tile["zone"]] and said["signatures_added"] == 0, f"{said}")
    only_changed(before, folder, tile["zone"])
    need(sorted(map(tuple, exported(folder, "file")[name]["points"])) == sorted(map(tuple, kept)), f"{name} is as it was")


def check_glim(work, submaps):
    clouds.write_glim(work / "glim-earlier", submaps[:EARLIER])
    clouds.write_glim(work / "glim", submaps)
    base = work / "submaps"
    build(work / "glim-earlier", base)
    folder = fresh(base, "map")
    said, _ = update(folder, "--db", work / "glim", "--add")
    need((said["signatures_shared"], said["signatures"], said["ids_mapped"]) == (EARLIER, len(submaps), []), f"{said}")
    need(update(folder, "--db", work / "glim", "--add")[0]["unchanged"], "glim: changed again")


def check_placing(work):
    """Options that place a map are refused where the source has its frame already."""
    (work / "path.txt").write_text("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n")
    for source in (DATABASE, work / "now.pcd", work / "glim"):
        for option in (("--align", work / "path.txt"), ("--scale", 2), ("--up", "0,0,1"), ("--camera-in-base", "0,0,0,0,0,0")):
            done = build(source, work / "never", *option, code=2)
            need(f"{option[0]}: {source} is " in done.stderr and "Leave it out" in done.stderr, done.stderr)
            need(not (work / "never" / "manifest.zpm").exists(), f"{option[0]} left a map")
    zonepack("outline", "--db", DATABASE, "--align", work / "path.txt", "--out", work / "never", code=2)
    zonepack("check-zones", ZONES, "--db", DATABASE, "--scale", 2, code=2)
    refused(work / "pcd", "--align: ", "--db", work / "now.pcd", "--replace", "C2", "--align", work / "path.txt", code=2)
    build(DATABASE, work / "rtabmap")
    refused(work / "rtabmap", "--scale: ", "--db", DATABASE, "--replace", "C2", "--scale", 2, code=2)
    refused(work / "rtabmap", "path.txt: the alignment", "--db", DATABASE, "--replace", "C2", "--align", work / "path.txt")


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        submaps = list(clouds.submaps_of(DATABASE))
        in_map = [[tuple(clouds.single(v) for v in clouds.place(T, p[:3])) + p[3:] for p in own] for _, _, T, own in submaps]
        points = [p for own in in_map for p in own]
        check_stella(work)
        check_pcd(work, [p for own in in_map[:EARLIER] for p in own], points)
        check_autoware(work, points)
        check_glim(work, submaps)
        check_placing(work)
    check_memory()
    print("update_kinds_test: updates take what they name, of every kind")


if __name__ == "__main__":
    main()
