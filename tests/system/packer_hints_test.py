#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: packer_hints_test.py ZONEPACK SOURCE: every command that a message of zonepack suggests works when typed.

For each hint: a world in which zonepack prints it, the command as printed, and what is right afterwards. A hint in the
sources that no case here types is a fault.
"""
import bz2
import gzip
import lzma
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

# Commands in messages, in the sources; NOT_IN_DEBIAN and PACKAGES are named as such, not typed.
SUGGESTED = re.compile(r"\b(sqlite3 |gunzip |unxz |unzstd |bunzip2 |unzip |7z x|git lfs|mkdir -p|rtabmap-re\w+"
                       r"|zonepack (?:prune|verify|check-zones) )")
NOT_IN_DEBIAN = {"rtabmap-recovery", "rtabmap-reprocess"}
PACKAGES = {"7z x": "p7zip-full", "git lfs": "git-lfs"}
typed = set()


class World:
    """A folder with the sample as map.db and zones.geojson."""

    def __init__(self, folder, zonepack, data):
        self.folder, self.zonepack = Path(folder), zonepack
        shutil.copy(data / "hospital-small.db", self.folder / "map.db")
        shutil.copy(data / "zones.geojson", self.folder)

    def path(self, name):
        return self.folder / name

    def shell(self, command):
        return subprocess.run(["bash", "-c", f'set -o pipefail; PATH="{self.zonepack.parent}:$PATH"; {command}'],
                              cwd=self.folder, capture_output=True, text=True)

    def zonepack_says(self, arguments, pattern, code=1):
        """Runs zonepack, and returns the hint that the pattern's group finds in what it prints."""
        done = self.shell("zonepack " + arguments)
        text = done.stdout + done.stderr
        assert done.returncode == code, f"zonepack {arguments}: exit code {done.returncode}\n{text}"
        found = re.search(pattern, text)
        assert found, f"zonepack {arguments}: nothing like {pattern} in\n{text}"
        return found.group(1)

    def type(self, hint, code=0):
        typed.update(SUGGESTED.findall(hint + " "))
        done = self.shell(hint)
        assert done.returncode == code, f"{hint}: exit code {done.returncode}\n{done.stdout}{done.stderr}"
        return done.stdout + done.stderr

    def build(self, more=""):
        done = self.shell("zonepack build --db map.db --zones zones.geojson --out map " + more)
        assert done.returncode == 0, done.stdout + done.stderr


def write_ahead_log(world):
    writer = sqlite3.connect(world.path("map.db"))
    writer.execute("PRAGMA journal_mode=WAL")
    writer.execute("UPDATE Node SET stamp = stamp + 1")
    writer.commit()
    for end in ("", "-wal"):  # as a killed RTAB-Map leaves them
        shutil.copy(world.path("map.db" + end), world.path("killed.db" + end))
    hint = world.zonepack_says("outline --db killed.db --out outline", r"run: (sqlite3 .*)")
    writer.close()
    world.type(hint)
    world.type("zonepack outline --db killed.db --out outline")


def hot_journal(world):
    writer = sqlite3.connect(world.path("map.db"), isolation_level=None)
    writer.execute("PRAGMA cache_size=1")
    writer.execute("BEGIN EXCLUSIVE")
    writer.execute("UPDATE Data SET user_data = zeroblob(3000)")
    for end in ("", "-journal"):
        shutil.copy(world.path("map.db" + end), world.path("killed.db" + end))
    hint = world.zonepack_says("outline --db killed.db --out outline", r"restore it: (sqlite3 .*)")
    writer.execute("ROLLBACK")
    writer.close()
    world.type(hint)
    world.type("zonepack outline --db killed.db --out outline")


def damaged_pages(world):
    size = world.path("map.db").stat().st_size
    with open(world.path("map.db"), "r+b") as file:
        for at in range(size // 2 // 4096 * 4096, size // 2 + 40 * 4096, 4096):
            file.seek(at)
            file.write(b"\xA5" * 4096)
    hint = world.zonepack_says("build --db map.db --zones zones.geojson --out map", r"readable with: (sqlite3 .*?) \(")
    world.shell(hint)  # sqlite3 itself reports the damage by its exit code
    typed.update(SUGGESTED.findall(hint))
    saved = sqlite3.connect(world.path("NEW.db"))
    assert saved.execute("SELECT count(*) FROM Node").fetchone()[0] > 0
    saved.close()


def compressed(world):
    whole = world.path("map.db").read_bytes()
    world.path("a.db").write_bytes(gzip.compress(whole, 1))
    world.path("b.db").write_bytes(lzma.compress(whole, preset=0))
    world.path("c.db").write_bytes(bz2.compress(whole, 1))
    names = ["a", "b", "c"]
    if shutil.which("zstd"):
        world.shell("zstd -1 -q map.db -o d.db")
        names.append("d")
    else:
        typed.add("unzstd ")
    for name in names:
        hint = world.zonepack_says(f"outline --db {name}.db --out outline", r"first: (.*?); expected")
        world.type(hint)
        assert world.path("NEW").read_bytes() == whole, hint
    with zipfile.ZipFile(world.path("e.db"), "w") as archive:
        archive.writestr("inside.db", whole)
    world.type(world.zonepack_says("outline --db e.db --out outline", r"first: (.*?); expected"))
    assert world.path("inside.db").read_bytes() == whole


def large_file_pointer(world):
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 5\n"
    world.path("map.db").write_text(pointer)
    hint = world.zonepack_says("outline --db map.db --out outline", r"run: (git lfs pull \(package git-lfs\))")
    world.path("map.db").write_bytes(b"7z\xBC\xAF\x27\x1C" + b"x" * 60)
    hint += world.zonepack_says("outline --db map.db --out outline", r"first: (7z x .* \(package p7zip-full\))")
    typed.update(SUGGESTED.findall(hint))
    for command, package in PACKAGES.items():
        assert command in hint
        known = subprocess.run(["apt-cache", "show", package], capture_output=True, check=False) if shutil.which(
            "apt-cache") else None
        # Without lists of packages there is nothing to compare with.
        assert known is None or known.returncode == 0 or not list(Path("/var/lib/apt/lists").glob("*Packages*")), package


def missing_folder(world):
    world.type(world.zonepack_says("export map --out 'a b/map.jsonl'", r"first: (mkdir .*)"))
    assert world.path("a b").is_dir()


def old_packs(world):
    world.build()
    hint = world.zonepack_says("build --db map.db --zones zones.geojson --out map --payload grid",
                               r"(zonepack prune \S+)\n", code=0)
    assert world.zonepack_says("verify map", r"(zonepack prune \S+)\n", code=0) == hint
    assert "removed" in world.type(hint)
    assert "prune" not in world.shell("zonepack verify map").stdout


def damaged_map(world):
    world.build()
    with open(world.path("map/manifest.zpm"), "r+b") as file:
        file.seek(1000)
        file.write(b"\xA5\xA5")
    hint = world.zonepack_says("plan map", r"damaged: (zonepack verify [^;]*);")
    assert "DAMAGED" in world.type(hint, code=1)
    pack = next(world.path("map").glob("*.zpk"))
    with open(pack, "r+b") as file:
        file.truncate(100)
    hint = world.zonepack_says(f"inspect {pack}", r"damaged: (zonepack verify .*)")
    assert "DAMAGED" in world.type(hint, code=1)


def next_step(world):
    hint = world.zonepack_says("outline --db map.db --out outline", r"(zonepack check-zones .*)", code=0)
    assert "0 faults" in world.type(hint)


CASES = [write_ahead_log, hot_journal, damaged_pages, compressed, large_file_pointer, missing_folder, old_packs,
         damaged_map, next_step]


def untyped(source):
    """Commands in the string literals of the packer's messages that no case has typed."""
    files = sorted((source / "packer").rglob("*.cpp")) + [source / "platform/base/file_kind.cpp"]
    found = set()
    for path in files:
        text = re.sub(r"//.*", "", path.read_text())
        text = re.sub(r"add_examples\([^;]*;", "", text)  # packer_examples_test.py runs these
        for literal in re.findall(r'"((?:[^"\\]|\\.)*)"', re.sub(r'"\s*\n\s*"', "", text)):
            found.update(SUGGESTED.findall(literal))
    return found - typed - NOT_IN_DEBIAN


def main():
    zonepack, source = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    faults = []
    for case in CASES:
        with tempfile.TemporaryDirectory() as folder:
            try:
                case(World(folder, zonepack, source / "tests/data"))
            except AssertionError as fault:
                faults.append(f"{case.__name__}: {fault}")
    faults += [f"no case here types the hint '{command}'" for command in sorted(untyped(source))]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


sys.exit(main())
