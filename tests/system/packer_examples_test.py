#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: packer_examples_test.py ZONEPACK DATA: every example that a help of zonepack shows works as it stands.

Runs them on the sample database, in a folder where it is called map.db, a drive through it drive.txt, and a cloud of two
rooms cloud.pcd.
"""
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
import two_rooms  # noqa: E402

# Later commands need what the earlier ones write.
ORDER = ["outline", "suggest-zones", "check-zones", "build", "update", "diff", "log", "plan", "tune", "inspect", "verify",
         "export", "report", "prune"]


def help_of(zonepack, *words):
    return subprocess.run([zonepack, *words, "--help"], check=True, capture_output=True, text=True).stdout


def examples_in(text):
    """The lines below "Examples:"."""
    below = text.split("\nExamples:\n")
    return [line.strip() for line in below[1].splitlines() if line.strip()] if len(below) == 2 else []


def write_cloud(path):
    points = two_rooms.surface_points(step=0.08)
    lines = ["VERSION 0.7", "FIELDS x y z", "SIZE 4 4 4", "TYPE F F F", "COUNT 1 1 1", f"WIDTH {len(points)}", "HEIGHT 1",
             "VIEWPOINT 0 0 0 1 0 0 0", f"POINTS {len(points)}", "DATA ascii"]
    path.write_text("\n".join(lines + ["{:.4f} {:.4f} {:.4f}".format(*point) for point in points]) + "\n")


def main():
    zonepack, data = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    listed = help_of(zonepack)
    commands = re.findall(r"^  ([a-z][a-z-]*) {2,}", listed.split("Subcommands:")[1].split("Examples:")[0], re.MULTILINE)
    faults = []
    if sorted(commands) != sorted(ORDER):
        faults.append(f"subcommands {commands}, this test knows {ORDER}")
    examples = {command: examples_in(help_of(zonepack, command)) for command in commands}
    faults += [f"{command} --help shows no examples" for command, lines in examples.items() if not lines]
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(data / "hospital-small.db", Path(folder) / "map.db")
        shutil.copy(data / "zones.geojson", folder)
        shutil.copy(data / "scenario1_loop/base_groundtruth.txt", Path(folder) / "drive.txt")
        write_cloud(Path(folder) / "cloud.pcd")
        bin_folder = zonepack.parent
        for line in [line for command in ORDER for line in examples.get(command, [])] + examples_in(listed):
            if not line.startswith("zonepack "):
                faults.append(f"{line}: no command of zonepack")
                continue
            done = subprocess.run(["bash", "-c", f'PATH="{bin_folder}:$PATH"; {line}'], cwd=folder, capture_output=True,
                                  text=True)
            if line.startswith("zonepack build ") and not (Path(folder) / "robot-map").exists():
                shutil.copytree(Path(folder) / "map", Path(folder) / "robot-map")
            if done.returncode != 0:
                faults.append(f"{line}: exit code {done.returncode}\n{done.stderr}")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


sys.exit(main())
