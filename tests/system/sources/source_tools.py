# SPDX-License-Identifier: Apache-2.0
"""What the tests of sources share: running zonepack, and failing by the test's own name."""
import json
import math
import os
import resource
import subprocess
import sys
from pathlib import Path

BIN, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
DATABASE, ZONES = SOURCE / "tests/data/hospital-small.db", SOURCE / "tests/data/zones.geojson"
MOST_MEMORY = 256 << 20


def fail(what):
    sys.exit(f"{Path(sys.argv[0]).stem}: {what}")


def need(holds, what):
    if not holds:
        fail(what)


def zonepack(*arguments, code=0, **environment):
    command = [str(BIN / "zonepack"), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120,
                          env={**os.environ, **environment})
    need(done.returncode == code, f"{' '.join(command)}: exit code {done.returncode}, not {code}: {done.stderr}")
    return done


def build(source, out, *options, **how):
    return zonepack("build", "--db", source, "--zones", ZONES, "--out", out, *options, **how)


def polygons():
    """Of each zone that is drawn, its outline; the first point comes again at the end."""
    out = {}
    for feature in json.loads(ZONES.read_text())["features"]:
        if feature["geometry"]["type"] == "Polygon":
            out[feature["properties"]["name"]] = feature["geometry"]["coordinates"][0]
    return out


def inside(ring, x, y):
    odd = False
    for (ax, ay), (bx, by) in zip(ring, ring[1:]):
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            odd = not odd
    return odd


def near_border(ring, x, y):
    for (ax, ay), (bx, by) in zip(ring, ring[1:]):
        length = math.hypot(bx - ax, by - ay)
        share = max(0, min(1, ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length ** 2)) if length else 0
        if math.hypot(ax + share * (bx - ax) - x, ay + share * (by - ay) - y) < 1e-4:
            return True
    return False


def refused(work, name, content, *said, options=()):
    """`content` as a file, or what stands there for None: named with these words, and no map is left."""
    path = work / name
    if content is not None:
        path.write_bytes(content)
    done = build(path, work / "never", *options, code=1)
    for words in (name, *said):
        need(words in done.stderr, f"{name}: expected '{words}' in: {done.stderr}")
    need(not (work / "never" / "manifest.zpm").exists(), f"{name}: left a map")


def check_memory():
    """Of the largest run: a file that lies about its sizes makes nothing large."""
    sanitized = b"__asan_init" in (BIN / "zonepack").read_bytes()  # which keeps what was freed
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    need(most < MOST_MEMORY * (4 if sanitized else 1), f"a run took {most} bytes")
