# SPDX-License-Identifier: Apache-2.0
"""usage: hostile_maps_test.py BIN SOURCE MAKE_HOSTILE_MAP: maps that ask zoned for more memory than its budget.

Each kind of make_hostile_map is given to zoned at its start, with a budget and without, and at SIGHUP while the robot
drives. It is refused by name, and the peak of resident and of locked memory stays under the budget and 16 MiB.
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

BIN, SOURCE, MAKE = (pathlib.Path(argument).absolute() for argument in sys.argv[1:4])
DATA = SOURCE / "tests/data"
RUN = DATA / "scenario1_loop"
MIB = 1 << 20
BUDGET = 8 * MIB
OVERHEAD = 16 * MIB
WITHOUT_BUDGET = 4 * MIB  # what the hostile maps could claim and have, when nothing is set: next to nothing

failures = []


def fail(text):
    failures.append(text)
    print("FAILED:", text)


def in_proc(pid, *keys):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return [int(re.search(rf"^{key}:\s+(\d+) kB", status, re.M).group(1)) * 1024 for key in keys]


def privilege():
    may = subprocess.run(["chrt", "-f", "1", "true"], stderr=subprocess.DEVNULL).returncode == 0
    return [] if may else ["--allow-degraded"]


def command(folder, speed, *options):
    return [BIN / "zoned", "run", "--config", SOURCE / "config/agilex.yaml", "--map", folder,
            "--can", f"log:{RUN}/can0.log@{speed}", "--corrections", RUN / "corrections.txt",
            *privilege(), *options]


def at_start(kind, named, folder, most, *options):
    """A start that is refused; returns its peak."""
    with open("out.txt", "w") as out:
        # Between fork and exec a child counts this program's memory, 15 MiB, as its own: the least that is seen.
        line = ["sh", "-c", '"$@"; echo "exit $?"', "sh", *map(str, command(folder, 1000, *options))]
        child = subprocess.Popen(line, stdout=out, stderr=out)
        _, _, usage = os.wait4(child.pid, 0)
    said = pathlib.Path("out.txt").read_text()
    peak = usage.ru_maxrss * 1024
    if "exit 1" not in said or named not in said.split("exit 1")[0]:
        fail(f"{kind}: not refused by naming {named}: {said}")
    if any(ord(c) < 32 and c not in "\n\t" for c in said):
        fail(f"{kind}: control characters are printed")
    if peak > most:
        fail(f"{kind}: took {peak} bytes at start, more than {most}")
    return peak


def put(source, folder):
    for file in sorted(source.iterdir(), key=lambda f: f.suffix == ".zpm"):  # the manifest last
        shutil.copy(file, folder / ".coming")
        (folder / ".coming").rename(folder / file.name)


class Driving:
    """A zoned that drives with a map that is good."""

    def __init__(self, folder):
        self.folder = folder
        self.said = open("driving.txt", "w")
        self.child = subprocess.Popen(
            [str(word) for word in command(folder, 1, "--budget", f"{BUDGET}")], stdout=self.said,
            stderr=self.said)
        for _ in range(200):
            if self.child.poll() is not None:
                raise SystemExit("zoned ended: " + pathlib.Path("driving.txt").read_text())
            if in_proc(self.child.pid, "VmRSS")[0] > 3 * MIB and self.cycles() > 0:
                break
            time.sleep(0.05)
        time.sleep(0.5)

    def cycles(self):
        done = subprocess.run([BIN / "zonectl", "status"], capture_output=True)
        return 1 if done.returncode == 0 else 0

    def log(self):
        return pathlib.Path("driving.txt").read_text()

    def hang_up(self, expected):
        before = self.log().count("map is not changed")
        self.child.send_signal(signal.SIGHUP)
        for _ in range(400):
            if self.log().count("map is not changed") > before:
                break
            time.sleep(0.05)
        else:
            fail(f"{expected}: nothing is said at SIGHUP")
        time.sleep(0.1)
        return self.log().split("map is not changed")[-1]

    def end(self):
        self.child.terminate()
        if self.child.wait(20) != 0:
            fail("zoned did not end well: " + self.log())


def main():
    kinds = [line.split("\t") for line in subprocess.check_output([MAKE], text=True).splitlines()]
    for name in ("good", "second"):
        more = ["--max-zone-bytes", "300KiB"] if name == "second" else []
        subprocess.run([BIN / "zonepack", "build", "--db", DATA / "hospital-small.db", "--zones",
                        DATA / "zones.geojson", "--payload", "features,scan,grid", "--out", name, *more],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    good = pathlib.Path("good")
    for kind, _ in kinds:
        subprocess.run([MAKE, "good", kind, "hostile-" + kind], check=True)
    shutil.copytree(good, "map")
    rows = {kind: [] for kind, _ in kinds}
    for kind, named in kinds:
        folder = pathlib.Path("hostile-" + kind)
        rows[kind].append(at_start(kind, named, folder, BUDGET + OVERHEAD, "--budget", f"{BUDGET}"))
    for kind, named in kinds:
        if kind in ("slots", "most-slots"):
            rows[kind].append(at_start(kind + " without a budget", "z000000",
                                       pathlib.Path("hostile-" + kind), OVERHEAD + WITHOUT_BUDGET))
    driving = Driving(pathlib.Path("map"))
    usual, _ = in_proc(driving.child.pid, "VmRSS", "VmLck")
    locked = in_proc(driving.child.pid, "VmLck")[0]
    for kind, named in kinds:
        put(pathlib.Path("hostile-" + kind), driving.folder)
        said = driving.hang_up(kind)
        if named not in said:
            fail(f"{kind}: not refused by naming {named}: {said}")
        peak, resident, now_locked = in_proc(driving.child.pid, "VmHWM", "VmRSS", "VmLck")
        rows[kind] += [peak, resident, now_locked]
        if peak > BUDGET + OVERHEAD or now_locked > BUDGET + OVERHEAD:
            fail(f"{kind}: {peak} resident at most, {now_locked} locked at SIGHUP")
        if now_locked > locked + MIB or resident > usual + 2 * MIB:
            fail(f"{kind}: {resident} resident and {now_locked} locked after the refusal; {usual} and {locked} before")
    for kind, _ in kinds:
        (driving.folder / "z.zpk").unlink(missing_ok=True)
    put(good, driving.folder)
    if "is the version that is in use" not in driving.hang_up("good"):
        fail("the good map is no longer known: " + driving.log())
    driving.end()
    print("zoned's memory, KiB; peak at start, the same without a budget, and at SIGHUP: peak, then resident and locked "
          "after the refusal")
    print(f"{'map':18}", *(f"{name:>8}" for name in ("start", "freely", "SIGHUP", "resident", "locked")))
    for kind, figures in rows.items():
        cells = [f"{figure // 1024:8}" for figure in figures]
        print(f"{kind:18}", *(cells if len(cells) == 5 else cells[:1] + [f"{'':8}"] + cells[1:]))
    print(f"{'good, for these':18}", f"{'':8} {'':8} {'':8} {usual // 1024:8} {locked // 1024:8}")
    return 1 if failures else 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        os.environ["ZONED_SOCKET"] = work + "/run/zoned.sock"
        sys.exit(main())
