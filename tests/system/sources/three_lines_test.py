#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: three_lines_test.py BIN SOURCE: the commands of "Three lines for each" in packer/README.md work as typed.

In a folder that holds each kind of map by the name that the page gives it, each kind without what the one before wrote.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from source_tools import BIN, DATABASE, SOURCE, need, zonepack
import slice_test as rooms

sys.path.insert(0, str(SOURCE / "tests/support"))
import stella_map  # noqa: E402


def lines_in_page():
    page = (SOURCE / "packer/README.md").read_text()
    section = re.search(r"^### Three lines for each\n(.*?)^##", page, re.MULTILINE | re.DOTALL)[1]
    lines = re.findall(r"^    (.*)$", section, re.MULTILINE)
    need(len(lines) == 18, f"expected three lines for each of six kinds, found {lines}")
    return [lines[i:i + 3] for i in range(0, len(lines), 3)]


def write_maps(work):
    shutil.copy(DATABASE, work / "map.db")
    zonepack("outline", "--db", work / "map.db", "--out", work / "floor")
    made = stella_map.StellaMap(*stella_map.read_rtabmap(DATABASE, 10**9), 0.4, "Monocular")
    made.write_msgpack(work / "map.msg", False)
    with open(work / "base.txt", "w", encoding="ascii") as out:
        for stamp, p, q in made.trajectory:
            out.write(f"{stamp:.9f} " + " ".join(f"{value:.9f}" for value in p + q) + "\n")
    points = rooms.two_rooms.surface_points()
    rooms.clouds.write_pcd(work / "cloud.pcd", rooms.colored(points), "binary")
    rooms.clouds.write_autoware(work / "tiles", rooms.colored(points), 4)
    rooms.clouds.write_glim(work / "dump", rooms.submaps_of(points))
    rooms.write_blocks(work / "map.nvblx", "tsdf_layer")


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        write_maps(work)
        for lines in lines_in_page():
            for line in lines:
                done = subprocess.run(["bash", "-c", line], cwd=work, capture_output=True, text=True, check=False,
                                      env={**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"})
                need(done.returncode == 0, f"{line}: exit code {done.returncode}: {done.stdout}{done.stderr}")
            need((work / "map/manifest.zpm").exists(), f"{lines[1]}: no map")
            shutil.rmtree(work / "map")
            (work / "zones.geojson").unlink()
    print("three_lines_test: six kinds of maps, three lines each")


if __name__ == "__main__":
    main()
