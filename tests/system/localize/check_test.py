#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: check_test.py BIN SOURCE: zoneloc check of the sample drive by its own calibration and by ones that are wrong in
one thing: each is named with its sign and size, within two of the standard deviations that are stated, and what is
printed to be pasted puts it right. What the map is off by is the same in both of a pair, so their difference is held to
2 %. Then bad inputs, each named.
"""
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
DRIVE = SOURCE / "tests/data/scenario1_loop"
FX, HEIGHT_M, DEGREE = 385, 0.5, math.pi / 180

# How the calibration differs from the camera, and what the camera has more than it says.
#   focal length: 385 / (1.02 * 385) - 1 = -0.0196; 385 / (0.98 * 385) - 1 = 0.0204
CASES = {
    "right": ({}, None, 0),
    "longer": ({"fx": FX * 1.02}, "focal", 1 / 1.02 - 1),
    "shorter": ({"fx": FX * 0.98}, "focal", 1 / 0.98 - 1),
    "lower": ({"height_m": HEIGHT_M + 0.05}, "height", -0.05),
    "higher": ({"height_m": HEIGHT_M - 0.05}, "height", 0.05),
    "up": ({"pitch_rad": DEGREE}, "pitch", -DEGREE),
    "down": ({"pitch_rad": -DEGREE}, "pitch", DEGREE),
}
SENTENCES = {
    "right": "nothing seems wrong with right.yaml",
    "longer": r"the focal length seems (2\.\d|1\.9) \+- 0\.\d % shorter than longer.yaml says",
    "shorter": r"the focal length seems (2\.\d|1\.9) \+- 0\.\d % longer than shorter.yaml says",
    "lower": r"the camera seems (5\.\d|4\.[6-9]) \+- 0\.\d cm lower than lower.yaml says",
    "higher": r"the camera seems (5\.\d|4\.[6-9]) \+- 0\.\d cm higher than higher.yaml says",
    "up": r"the camera seems to look (1\.\d\d|0\.9\d) \+- 0\.\d\d degrees higher than up.yaml says",
    "down": r"the camera seems to look (1\.\d\d|0\.9\d) \+- 0\.\d\d degrees lower than down.yaml says",
}
KEY = {"focal": "camera_matrix", "height": "local_transform", "pitch": "local_transform"}


def need(holds, what):
    if not holds:
        sys.exit(f"check_test: {what}")


def run(*command, code=0):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, timeout=1200)
    need(done.returncode == code, f"{' '.join(map(str, command))}: exit code {done.returncode}, not {code}: "
                                  f"{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def calibration(fx=FX, height_m=HEIGHT_M, pitch_rad=0.0, width=640, height=480):
    """The sample's camera looks along base_link's x; a positive pitch turns the view down."""
    c, s = math.cos(pitch_rad), math.sin(pitch_rad)
    mount = [0, -s, c, 0.2, -1, 0, 0, 0, 0, -c, -s, height_m]
    return (f"%YAML:1.0\n---\nimage_width: {width}\nimage_height: {height}\n"
            f"camera_matrix: {{rows: 3, cols: 3, data: [{fx}, 0, 319.5, 0, {fx}, 239.5, 0, 0, 1]}}\n"
            "distortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n"
            f"local_transform: {{rows: 3, cols: 4, data: {mount}}}\n")


def pasted(text, yaml):
    """The calibration with the keys of `yaml` over its own."""
    for key in re.findall(r"^(\w+):", yaml, re.M):
        text = re.sub(rf"^{key}: .*\n", "", text, flags=re.M)
    return text + yaml


def check(calibration_file, *more, images=DRIVE / "rgb.txt", start=None, code=0):
    return run(BIN / "zoneloc", "check", "--config", SOURCE / "config/agilex.yaml", "--map", "map", "--can",
               DRIVE / "can0.log", "--images", images, "--calibration", calibration_file,
               f"--start={start or start_of_drive()}", *more, code=code)


def start_of_drive():
    for line in (DRIVE / "base_groundtruth.txt").read_text().splitlines():
        if not line.startswith("#"):
            _, x, y, _, _, _, z, w = map(float, line.split()[:8])
            return f"{x},{y},{2 * math.atan2(z, w) / DEGREE:.4f}"
    return None


def check_case(name):
    changes, trait, off = CASES[name]
    text = calibration(**changes)
    Path(f"{name}.yaml").write_text(text)
    said = check(f"{name}.yaml", "--json", f"{name}.json")
    result = json.loads(Path(f"{name}.json").read_text())
    need(re.search(SENTENCES[name], said), f"no '{SENTENCES[name]}' in: {said}")
    need(result["images"] > 200 and result["fixes"] > 180, f"expected fixes of most images: {result}")
    need({one["trait"] for one in result["tested"]} == {"focal", "height", "pitch", "roll"}, f"not tested: {result}")
    need(result["ok"] == (trait is None), f"ok is wrong: {result}")
    if trait is None:
        need(result["findings"] == [] and result["yaml"] is None, f"expected no finding: {result}")
        return 0
    need([one["trait"] for one in result["findings"]] == [trait], f"expected {trait} alone: {result}")
    value, sigma = result["findings"][0]["value"], result["findings"][0]["sigma"]
    need(abs(value - off) <= 2 * sigma, f"{name}: expected {off} +- 2 * {sigma}, not {value}")
    need(0 < sigma < abs(off) / 10, f"{name}: an error of {sigma} is too much for {off}")
    need(result["yaml"] in said, f"the YAML is not printed: {said}")
    need(re.findall(r"^(\w+):", result["yaml"], re.M) == [KEY[trait]], f"expected {KEY[trait]}: {result['yaml']}")
    if name in ("longer", "lower"):
        Path(f"{name}_mended.yaml").write_text(pasted(text, result["yaml"]))
        said = check(f"{name}_mended.yaml")
        need("nothing seems wrong" in said, f"{name}: what was pasted does not put it right: {said}")
    return value


def check_bad_input():
    def refused(words, *more, **how):
        said = check("right.yaml", *more, code=1, **how)
        for word in words:
            need(word in said, f"no '{word}' in: {said}")
    rows = [line for line in (DRIVE / "rgb.txt").read_text().splitlines() if not line.startswith("#")]
    listed = [f"{row.split()[0]} {DRIVE / row.split()[1]}" for row in rows]
    Path("few.txt").write_text("\n".join(listed[:30]) + "\n")
    Path("gone.txt").write_text("\n".join(row.replace(".jpg", ".png") for row in listed) + "\n")
    Path("another_day.txt").write_text("\n".join(f"{i}.0 {row.split()[1]}" for i, row in enumerate(listed)) + "\n")
    Path("nothing.txt").write_text("# stamp file\n")
    Path("small.yaml").write_text(calibration(width=320, height=240))
    refused(["few.txt: ", "fixes in 30 images are too few to judge right.yaml", "about 40 are needed"], images="few.txt")
    refused(["another_day.txt", "can0.log"], images="another_day.txt")
    refused(["gone.txt", ".png"], images="gone.txt")
    refused(["nothing.txt"], images="nothing.txt")
    said = check("small.yaml", code=1)
    need("640x480" in said and "small.yaml is for images of 320x240" in said, f"the sizes are not named: {said}")
    refused(["nowhere/out.json"], "--json", "nowhere/out.json")
    said = check("none.yaml", code=1)
    need("none.yaml" in said, f"a missing calibration is not named: {said}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        run(BIN / "zonepack", "build", "--db", SOURCE / "tests/data/hospital-small.db", "--zones",
            SOURCE / "tests/data/zones.geojson", "--out", "map", "--payload", "features")
        with ThreadPoolExecutor(max_workers=2) as several:
            found = dict(zip(CASES, several.map(check_case, CASES)))
        for more, less in (("shorter", "longer"), ("higher", "lower"), ("down", "up")):
            apart, expected = found[more] - found[less], CASES[more][2] - CASES[less][2]
            need(abs(apart / expected - 1) < 0.02, f"{more} and {less}: expected {expected} between them, not {apart}")
        check_bad_input()
    print("zoneloc check names what is wrong with a calibration, with its sign and size")


main()
