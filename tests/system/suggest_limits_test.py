#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: suggest_limits_test.py BIN SOURCE: grids that are too large or no floor plan, in bounded memory, in bytes.

Of an image that is too large nothing is read but its header; noise is refused before each of its pieces gets tables.
"""
import random
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

BIN = Path(sys.argv[1]).resolve()
MIB = 1 << 20


def need(holds, what):
    if not holds:
        sys.exit(f"suggest_limits_test: {what}")


def write_grid(path, width, height, pixels=b"", holes=0):
    """A PGM, the end of it a hole of the file, and its YAML file."""
    with open(path, "wb") as out:
        out.write(f"P5\n{width} {height}\n255\n".encode() + pixels)
        out.truncate(out.tell() + holes)
    yaml = path.with_suffix(".yaml")
    yaml.write_text(f"image: {path.name}\nresolution: 0.05\norigin: [0, 0, 0]\n", encoding="ascii")
    return yaml


def peak_of(*words):
    """What a run says, and its resident memory at most, in bytes; the first may not be of a larger run before."""
    command = [BIN / "zonepack", "suggest-zones", *words]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as run:
        said = run.stdout.read()
    need(run.returncode == 1, f"{words}: exit code {run.returncode}: {said}")
    return said, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024


def refused(work, yaml, most, *expected):
    said, peak = peak_of("--grid", yaml, "--out", work / "zones.geojson")
    for words in expected:
        need(words in said, f"{yaml.name}: expected '{words}' in: {said}")
    need(not (work / "zones.geojson").exists(), f"{yaml.name}: left zones")
    sanitized = b"__asan_init" in (BIN / "zonepack").read_bytes()  # which keeps what was freed
    need(peak < most * (4 if sanitized else 1), f"{yaml.name}: a run took {peak} bytes")
    print(f"{yaml.name}: refused in {peak / MIB:.0f} MiB")


def noise(side):
    """Black, white and grey by chance, a third each."""
    return bytes(random.Random(7).choices((0, 205, 254), k=side * side))


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        cut = "cut it, or save it at a coarser resolution"
        claim = write_grid(work / "claim.pgm", 30_000, 30_000)
        refused(work, claim, 64 * MIB, "claim.pgm", "30000 x 30000 pixels, at most 67108864", cut)
        huge = write_grid(work / "huge.pgm", 20_000, 20_000, noise(1000), 399_000_000)
        refused(work, huge, 64 * MIB, "huge.pgm", "20000 x 20000 pixels, at most 67108864", cut)
        short = write_grid(work / "short.pgm", 8192, 8192)
        refused(work, short, 64 * MIB, "short.pgm", "ends early", "need 67108864 bytes after the header, it has 0")
        side = 3000
        many = write_grid(work / "noise.pgm", side, side, noise(side))
        refused(work, many, 60 * side * side, "noise.yaml", "more than a zone file may hold",
                "expected a floor plan, not noise", "coarser resolution")
        dots = (b"\xfe\0" * (side // 2) + bytes(side)) * (side // 2)  # free cells, each alone
        dotted = write_grid(work / "dots.pgm", side, side, dots)
        refused(work, dotted, 60 * side * side, "dots.yaml", "2250000 pieces, at most 524288", "coarser resolution")


if __name__ == "__main__":
    main()
