#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: runtime_hints_test.py BIN SOURCE: every command that a message of zoned, zonectl or zoneloc suggests works when typed.

For each hint: a world in which a program prints it, the command as printed, and what is right afterwards. A hint in the
sources that no case here types is a fault. What needs a bus or changes a kernel's settings is typed on the virtual robot
(tests/system/guest/check_test.sh and controllers_test.sh), and named in ON_THE_ROBOT.
"""
import gzip
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

BIN, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
DATA = SOURCE / "tests/data"
DRIVE = DATA / "scenario1_loop"
REPLAY = f"zoned replay --config {SOURCE}/config/agilex.yaml --can {DRIVE}/can0.log --start 0.875,10.975,-149 "
QUERY = f"zoneloc query --map map --image {DRIVE}/rgb/1718021685.000000.jpg --calibration {DRIVE}/calibration.yaml "
NEAR = "--near 3.0,-8.5,30 "

# Commands in messages, in the sources.
SUGGESTED = re.compile(r"\b(ip link|ip -details|sysctl|modprobe|mkdir -p|gpioinfo|gpiodetect|usermod|python3 -m|apt install"
                       r"|ulimit -\w|dmesg|zonectl (?:pose|unfreeze)|zonepack (?:plan|verify|inspect))")
ON_THE_ROBOT = {"ip link", "sysctl"}
# What is typed elsewhere, is no command of its own but where to look, or would change this machine.
NOT_TYPED = {"ip -details": "lists devices", "modprobe": "loads a module", "apt install": "installs", "usermod": "changes a user",
             "gpioinfo": "lists lines", "gpiodetect": "lists chips", "dmesg": "shows the kernel's log",
             "python3 -m": "tests/unit/platform/can/can_log_asc_test.cpp", "ulimit -f": "tests/system/serve/ending_test.sh",
             "ulimit -l": "a limit of the unit", "ulimit -r": "a limit of the unit"}
typed = set()


class World:
    """A folder with the sample as map, and a zoned when one is started."""

    def __init__(self, folder):
        self.folder, self.zoned = Path(folder), None
        self.around = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}", "ZONED_SOCKET": str(self.folder / "zoned.sock")}
        self.types(f"zonepack build --db {DATA}/hospital-small.db --zones {DATA}/zones.geojson --out map --payload features")

    def shell(self, command):
        return subprocess.run(["bash", "-c", command], cwd=self.folder, capture_output=True, text=True, check=False,
                              env=self.around)

    def says(self, command, pattern, code=1):
        """The hint that the pattern's group finds in what the command prints."""
        done = self.shell(command)
        text = done.stdout + done.stderr
        assert done.returncode == code, f"{command}: exit code {done.returncode}\n{text}"
        found = re.search(pattern, text)
        assert found, f"{command}: nothing like {pattern} in\n{text}"
        return found.group(1)

    def types(self, hint, code=0):
        typed.update(SUGGESTED.findall(hint))
        done = self.shell(hint)
        assert done.returncode == code, f"{hint}: exit code {done.returncode}\n{done.stdout}{done.stderr}"
        return done.stdout + done.stderr

    def serve(self, speed, more=""):
        self.zoned = subprocess.Popen(
            ["bash", "-c", f"exec zoned run --config {SOURCE}/config/agilex.yaml --map map --can log:{DRIVE}/can0.log@{speed} "
             f"--allow-degraded {more}"], cwd=self.folder, env=self.around, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        for _ in range(200):
            if (self.folder / "zoned.sock").is_socket():
                return
            time.sleep(0.05)
        raise AssertionError("zoned does not serve")

    def end(self):
        if self.zoned is not None:
            self.zoned.terminate()
            self.zoned.wait()


def missing_folder(world):
    for command, out in ((REPLAY + "--map map", "--json"), (QUERY + NEAR, "--draw")):
        folder = f"a b{out}"
        file = "it.png" if out == "--draw" else "it.json"
        broken = f"{command} {out} '{folder}/{file}'"
        world.types(world.says(broken, r"; (mkdir -p .*)"))
        assert world.shell(broken).returncode == 0 and (world.folder / folder / file).is_file()


def compressed_log(world):
    (world.folder / "it's.gz").write_bytes(gzip.compress((DRIVE / "can0.log").read_bytes(), 1))
    hint = world.says(f"zoned replay --config {SOURCE}/config/agilex.yaml --map map --can \"it's.gz\"", r"first: (.*?); expected")
    world.types(hint)
    assert (world.folder / "NEW").read_bytes() == (DRIVE / "can0.log").read_bytes()


def no_map(world):
    assert "--zones" in world.types(world.says(REPLAY + "--map nothing", r"nothing/manifest.zpm: .*: (zonepack build --help)"))


def damaged_manifest(world):
    with open(world.folder / "map/manifest.zpm", "r+b") as file:
        file.seek(1000)
        file.write(b"\xA5\xA5")
    shutil.move(world.folder / "map", world.folder / "my map")
    assert "DAMAGED" in world.types(world.says(REPLAY + "--map 'my map'", r": (zonepack verify .*)"), code=1)


def damaged_pack(world):
    for pack in (world.folder / "map").glob("*.zpk"):
        os.truncate(pack, 100)
    assert "DAMAGED" in world.types(world.says(QUERY + NEAR, r"; (zonepack verify \S+) says"), code=1)


def budget_too_small(world):
    broken = REPLAY + "--map map --budget 200KiB"
    smallest = world.says(broken, r"smallest budget for this map is .*?(\d+)")
    assert smallest in world.types(world.says(broken, r": (zonepack plan \S+)")), smallest


def zone_that_is_not_there(world):
    assert "L1" in world.types(world.says(QUERY + "--zone NOPE", r"; (zonepack inspect \S+) lists them"))


def no_pose(world):
    world.serve("1")
    hint = world.says("zonectl status", r"or for (zonectl pose X Y YAW_DEG)", code=0)
    world.types(hint.replace("X Y YAW_DEG", "0.875 10.975 -149"))
    world.says("sleep 0.2; zonectl status", r"(POSE NOT TRUSTED)", code=0)


def frozen(world):
    world.serve("20", f"--corrections {DRIVE}/corrections.txt")
    world.types("zonectl freeze")
    hint = world.says("timeout 60 bash -c 'until zonectl status | grep BLOCKED; do sleep 0.1; done'", r"; (zonectl unfreeze)",
                      code=0)
    world.types(hint)
    world.says("sleep 0.2; zonectl status", r"(frozen +no)", code=0)


CASES = [missing_folder, compressed_log, no_map, damaged_manifest, damaged_pack, budget_too_small, zone_that_is_not_there,
         no_pose, frozen]


def untyped():
    """Commands in the string literals of the robot's messages that no case has typed."""
    found = set()
    for path in sorted((SOURCE / "runtime").rglob("*.cpp")) + sorted((SOURCE / "platform").rglob("*.cpp")):
        text = re.sub(r"//.*", "", path.read_text())
        for literal in re.findall(r'"((?:[^"\\]|\\.)*)"', re.sub(r'"\s*\n\s*"', "", text)):
            found.update(SUGGESTED.findall(literal))
    return found


def main():
    faults = []
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            world = World(folder)
            try:
                case(world)
            except AssertionError as fault:
                faults.append(f"{case.__name__}: {fault}")
            finally:
                world.end()
    there = untyped()
    faults += [f"no case here types the hint '{command}'" for command in sorted(there - typed - ON_THE_ROBOT - set(NOT_TYPED))]
    faults += [f"no message holds '{command}' any more" for command in sorted((ON_THE_ROBOT | set(NOT_TYPED)) - there)]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


sys.exit(main())
