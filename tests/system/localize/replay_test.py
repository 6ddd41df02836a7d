#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: replay_test.py BIN SOURCE DOUBLE_IMAGE: zoneloc replay and zoneloc query on the sample map. A robot stands
still where a signature of the database was taken, and its camera gives that signature's image, doubled: good fixes
without a byte of images in the repository. Then every kind of bad input, each refused by name.
"""
import json
import math
import os
import re
import sqlite3
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from black_png import black_png

BIN, SOURCE, DOUBLE = (Path(argument).resolve() for argument in sys.argv[1:4])
DATABASE = SOURCE / "tests/data/hospital-small.db"
WIDTH, HEIGHT = 640, 480
HERE = 50  # signature
START_S, LASTS_S, IMAGES = 1000, 8, 10
CALIBRATION = """%YAML:1.0
---
image_width: {0}
image_height: {1}
camera_matrix: {{rows: 3, cols: 3, data: [385, 0, {2}, 0, 385, {3}, 0, 0, 1]}}
distortion_model: plumb_bob
distortion_coefficients: {{rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}}
local_transform: {{rows: 3, cols: 4, data: [0, 0, 1, 0.2, -1, 0, 0, 0, 0, -1, 0, 0.5]}}
"""
SPREADS = ("fix_error_m", "fix_error_map_m", "pose_error_m", "yaw_error_deg", "query_ms")
BY_TRUTH = ("right", "wrong", "fix_error_m", "fix_error_map_m", "pose_error_m", "yaw_error_deg", "wrong_zone_s")


def fail(what):
    sys.exit(f"replay_test: {what}")


def need(holds, what):
    if not holds:
        fail(what)


def of_signature(column):
    with sqlite3.connect(f"file:{DATABASE}?mode=ro", uri=True) as database:
        table = "Data" if column == "image" else "Node"
        return database.execute(f"select {column} from {table} where id = ?", (HERE,)).fetchone()[0]


def pose_here():
    m = struct.unpack("<12f", of_signature("pose"))
    return m[3], m[7], math.atan2(m[4], m[0])


def run(*command, code=0):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, timeout=120)
    need(done.returncode == code, f"{' '.join(map(str, command))}: exit code {done.returncode}, not {code}: "
                                  f"{done.stdout}{done.stderr}")
    return done


def write(name, text):
    Path(name).write_text(text, encoding="utf-8")


def stamp_of(image):
    return START_S + 1 + 0.5 * image


def write_list(name, files, first_s=START_S + 1.0):
    write(name, "# stamp file\n" + "".join(f"{first_s + 0.5 * i:.6f} {file}\n" for i, file in enumerate(files)))


def prepare():
    """A still drive, its truth, ten images of it, bad ones, calibrations, the map."""
    frames = [line.split(maxsplit=1)[1] for line in
              (SOURCE / "tests/data/scenario1_loop/can0.log").read_text().splitlines()[:2]]
    write("still.log", "".join(f"({START_S + i * 0.02 + k * 0.0005:.6f}) {frame}\n"
                               for i in range(LASTS_S * 50) for k, frame in enumerate(frames)))
    x, y, yaw = pose_here()
    for name, dx in (("truth.txt", 0.0), ("far.txt", 1.0)):
        write(name, "".join(f"{START_S + 0.1 * i:.3f} {x + dx:.6f} {y:.6f} 0 0 0 {math.sin(yaw / 2):.9f} "
                            f"{math.cos(yaw / 2):.9f}\n" for i in range(LASTS_S * 10)))
    Path("small.jpg").write_bytes(of_signature("image"))
    for i in range(IMAGES):
        run(DOUBLE, "small.jpg", f"{i}.png", i + 1)
    Path("half.png").write_bytes(Path("0.png").read_bytes()[:50_000])
    Path("black.png").write_bytes(black_png(WIDTH, HEIGHT))
    Path("other_size.png").write_bytes(black_png(64, 48))
    write_list("rgb.txt", [f"{i}.png" for i in range(IMAGES)])
    write("camera.yaml", CALIBRATION.format(640, 480, 319.5, 239.5))
    write("other_camera.yaml", CALIBRATION.format(320, 240, 159.5, 119.5))
    run(BIN / "zonepack", "build", "--db", DATABASE, "--zones", SOURCE / "tests/data/zones.geojson", "--out", "map")


def start_here():
    x, y, yaw = pose_here()
    return f"{x:.4f},{y:.4f},{math.degrees(yaw):.3f}"


def replay(*more, images="rgb.txt", calibration="camera.yaml", start=None, code=0):
    done = run(BIN / "zoneloc", "replay", "--config", SOURCE / "config/agilex.yaml", "--map", "map", "--can",
               "still.log", "--images", images, "--calibration", calibration, "--start", start or start_here(),
               "--json", "out.json", *more, code=code)
    return (json.loads(Path("out.json").read_text(encoding="utf-8")), done.stderr) if code == 0 else done.stderr


def is_count(value):
    return isinstance(value, int) and not isinstance(value, bool) and value >= 0


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value) and value >= 0


def check_keys():
    result, _ = replay("--truth", "truth.txt", "--fixes", "fixes.txt", "--events", "ours.jsonl", "--report", "loop.html")
    for key in ("images", "accepted", "right", "wrong", "budget_violations", "rss_peak_bytes", "found_after_views"):
        need(is_count(result[key]), f"{key} is no count: {result}")
    for key in ("longest_gap_s", "wrong_zone_s", "zone_absent_s", "found_after_s"):
        need(is_number(result[key]), f"{key} is no number of seconds: {result}")
    for key in SPREADS:
        need(all(is_number(result[key][part]) for part in ("p50", "p95", "max")), f"{key} is no spread: {result}")
        need(result[key]["p50"] <= result[key]["p95"] <= result[key].get("p99", math.inf), f"{key} is not in order: {result}")
        need(result[key].get("p99", result[key]["p95"]) <= result[key]["max"], f"{key} is not in order: {result}")
    need(is_number(result["query_ms"]["p99"]), f"query_ms has no p99: {result}")
    stages = result["query_ms"]["stages"]
    need(stages and all(is_number(stage["p50"]) for stage in stages.values() if stage), f"no stages: {result}")
    need(sum(result["reasons"].values()) == result["images"] == IMAGES, f"expected {IMAGES} reasons: {result}")
    need(result["reasons"]["accepted"] == result["accepted"] == result["right"] == IMAGES, f"expected fixes: {result}")
    need(result["wrong"] == result["budget_violations"] == 0, f"expected nothing wrong: {result}")
    need(result["fix_error_m"]["max"] < 0.1 and result["pose_error_m"]["max"] < 0.1, f"far off: {result}")
    # Half a second between images, a second before the first, 2.5 s after the last (1005.5 to 1008).
    need(2.4 < result["longest_gap_s"] < 2.6, f"expected a gap of 2.5 s: {result}")
    need(result["rss_peak_bytes"] > 1 << 20, f"no memory: {result}")

    # What it wrote gives zoned the same events.
    run(BIN / "zoned", "replay", "--config", SOURCE / "config/agilex.yaml", "--map", "map", "--can", "still.log",
        "--start", start_here(), "--corrections", "fixes.txt", "--events", "theirs.jsonl")
    need(Path("ours.jsonl").read_bytes() == Path("theirs.jsonl").read_bytes() != b"",
         "zoned replay --corrections gives other events than the loop that wrote the fixes")
    need(len(Path("fixes.txt").read_text().splitlines()) >= IMAGES, "fewer fixes than images")

    # A truth that is a metre away: every fix is wrong by it.
    result, _ = replay("--truth", "far.txt")
    need(result["wrong"] == IMAGES and result["right"] == 0, f"expected {IMAGES} wrong fixes: {result}")
    need(0.9 < result["fix_error_m"]["p50"] < 1.1, f"expected an error of a metre: {result}")


def check_nulls():
    result, _ = replay()
    for key in BY_TRUTH:
        need(result[key] is None, f"{key} is not null without truth: {result}")
    need(result["accepted"] == IMAGES and result["found_after_views"] is not None, f"expected fixes: {result}")
    write_list("nothing.txt", ["black.png"])
    result, _ = replay(images="nothing.txt", start="lost")
    for key in ("zone_absent_s", "found_after_views", "found_after_s", *BY_TRUTH):
        need(result[key] is None, f"{key} is not null for a robot that never knew where it is: {result}")
    need(result["accepted"] == 0 and "accepted" not in result["reasons"], f"expected no fix: {result}")


def check_report():
    """Another localizer's run: three rows, of which one is a fix a metre off and one is none."""
    x, y, yaw = pose_here()
    rows = [(0, 7, x + 0.01), (1, 7, x + 1), (2, 0, x)]
    write("other.csv", "# init_ms=5\nt,accepted,mx,my,myaw\n" + "".join(
        f"{stamp_of(i):.6f},{accepted},{at:.6f},{y:.6f},{yaw:.6f}\n" for i, accepted, at in rows))
    replay("--truth", "truth.txt", "--beside", "other.csv", "--report", "loop.html", "--picture", "loop.svg")
    page = Path("loop.html").read_text(encoding="utf-8")
    for text in (f"A fix from {IMAGES} of {IMAGES} images (100.0 %), none of them wrong; RTAB-Map found 2 (66.7 %), 1 wrong.",
                 "fix (10)", "RTAB-Map (1)", "RTAB-Map, wrong (1)",
                 '<td>RTAB-Map</td><td class="n">3</td><td class="n">2</td><td class="n">66.7 %</td>'
                 '<td class="n">1</td><td class="n">1</td>'):
        need(text in page, f"no '{text}' in the report")
    need(len(re.findall(r'data-t="1000"', page)) >= 2, "no dot of the first image at second 1")
    need("RTAB-Map (1)" in Path("loop.svg").read_text(encoding="utf-8"), "nothing of RTAB-Map in the picture")
    replay("--beside", "truth.txt", "--picture", "loop.svg")
    need("truth.txt (80)" in Path("loop.svg").read_text(encoding="utf-8"), "poses as TUM's are not drawn")
    write("no_column.csv", "t,accepted,mx,my\n1001,1,0,0\n")
    need("no_column.csv:1: no column 'myaw'" in replay("--beside", "no_column.csv", code=1), "a column is not missed")
    write("other_day.csv", "t,accepted,mx,my,myaw\n5000,1,0,0,0\n")
    need("other_day.csv" in replay("--beside", "other_day.csv", "--picture", "loop.svg", code=1), "another day is taken")


def check_bad_input():
    def refused(words, *more, **how):
        if os.path.exists("none.txt"):
            os.remove("none.txt")
        said = replay("--fixes", "none.txt", *more, code=1, **how)
        for word in words:
            need(word in said, f"no '{word}' in: {said}")
        need(not os.path.exists("none.txt"), f"fixes are written although: {said}")
    write_list("other_day.txt", ["0.png"], first_s=1718021600.0)
    refused(("other_day.txt", "still.log"), images="other_day.txt")
    refused(("0.png: is 640x480", "other_camera.yaml is for images of 320x240", "give the calibration of this camera"),
            calibration="other_camera.yaml")
    write_list("missing.txt", ["0.png", "gone.png"])
    refused(("missing.txt", "gone.png"), images="missing.txt")
    refused(("none.yaml",), calibration="none.yaml")
    refused(("none_at_all.txt",), images="none_at_all.txt")
    write("empty.txt", "# stamp file\n")
    refused(("empty.txt",), images="empty.txt")

    # Bad images among good ones: each is named and gives no fix, the others do.
    write_list("mixed.txt", ["0.png", "half.png", "1.png", "1.png", "other_size.png", "2.png", "black.png"])
    result, said = replay("--fixes", "fixes.txt", images="mixed.txt")
    for words in ("half.png", "1.png: repeats the image before bit for bit", "other_size.png: is 64x48"):
        need(words in said, f"no '{words}' in: {said}")
    need(result["images"] == 7 and result["accepted"] == 3, f"expected 3 fixes of 7 images: {result}")
    need(result["reasons"]["unreadable_image"] == 2 and result["reasons"]["wrong_size"] == 1, f"reasons: {result}")
    fixes = [line for line in Path("fixes.txt").read_text().splitlines() if not line.startswith("#")]
    # Images 0, 2 and 5, at 1001 s, 1002 s and 1003.5 s.
    need([float(line.split()[0]) for line in fixes] == [1001.0, 1002.0, 1003.5], f"fixes of other images: {fixes}")


def query(*more, image="0.png", calibration="camera.yaml", code=0):
    return run(BIN / "zoneloc", "query", "--map", "map", "--image", image, "--calibration", calibration, *more, code=code)


def check_query():
    x, y, _ = pose_here()
    for where in (("--near", start_here()), ("--zone", "L1"), ("--lost",), ()):
        done = query(*where, "--json", "-")
        result = json.loads(done.stdout)  # and nothing else
        need(result["accepted"] is True and result["reason"] == "accepted", f"{where}: no pose: {result}")
        need(math.hypot(result["pose"]["x_m"] - x, result["pose"]["y_m"] - y) < 0.1, f"{where}: elsewhere: {result}")
        need("matches agree" in done.stderr, f"{where}: no text for people: {done.stderr}")
    result = json.loads(query("--zone", "R51", "--json", "-", "--draw", "why.png").stdout)
    need(result["accepted"] is False and result["why"], f"a place in the wrong zone: {result}")
    need(Path("why.png").read_bytes().startswith(b"\x89PNG"), "no drawing") if has_rsvg() else None
    query("--near", start_here(), "--draw", "found.svg")
    need("<svg" in Path("found.svg").read_text(encoding="utf-8"), "no drawing")
    result = json.loads(query("--lost", "--json", "-", image="black.png").stdout)
    need(result["reason"] == "no_features", f"something seen in the dark: {result}")

    def refused(words, *more, code=1, **how):
        said = query(*more, code=code, **how)
        need(words in said.stderr + said.stdout, f"no '{words}' in: {said.stderr}{said.stdout}")
    refused("half.png", image="half.png")
    refused("gone.png", image="gone.png")
    refused("has 640x480 pixels, but other_camera.yaml is of 320x240", calibration="other_camera.yaml")
    refused("has no zone 'R99'; zonepack inspect map lists them", "--zone", "R99")
    refused("'1,2' is not X,Y,YAW_DEG", "--near", "1,2", code=2)
    refused("excludes", "--near", "1,2,3", "--lost", code=2)
    refused("why.jpg", "--draw", "why.jpg", code=2)
    run(BIN / "zonepack", "inspect", "map")  # the hint works


def has_rsvg():
    return any(os.access(os.path.join(folder, "rsvg-convert"), os.X_OK) for folder in os.environ["PATH"].split(":"))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        prepare()
        check_keys()
        check_nulls()
        check_report()
        check_bad_input()
        check_query()
    print("zoneloc replay and query: keys, nulls, fixes that zoned repeats, bad input by name")


main()
