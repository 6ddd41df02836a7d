#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: old_reader_test.py BIN SOURCE [MAP ...]: reads maps of today as a robot of format version 1.0 does.

With the schemas of 1.0 (tests/golden), flatc and lz4, and nothing of Zonepack's: every chunk of a kind that 1.0 knows is
made of parts, fields and codecs that it knows, and chunks of other kinds can be left out. Of a cloud with intensity, rgb
and ring such a robot loads all six channels, and hands on the format, which is new to it, as a number. MAP: other maps to
read so.
"""
import json
import re
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

BIN, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
GOLDEN = SOURCE / "tests/golden"
sys.path.insert(0, str(SOURCE / "tests/support"))
import hospital_cloud as clouds  # noqa: E402
import stella_map  # noqa: E402

KINDS = ("Core", "Features", "Scan", "Grid", "Image", "Depth", "UserData")
FRAME = b"\x04\x22\x4d\x18\x60\x40\x82"  # of an lz4 file: blocks of up to 64 KiB, no checksums
ROOTS = {"manifest": "Manifest", "pack": "PackIndex", "core_chunk": "CoreChunk", "bulk_chunk": "BulkChunk"}


def need(holds, what):
    if not holds:
        sys.exit(f"old_reader_test: {what}")


def run(*command, **how):
    done = subprocess.run([str(word) for word in command], capture_output=True, check=False, **how)
    need(done.returncode == 0, f"{command}: {done.stderr.decode(errors='replace')}")
    return done.stdout


def decode(work, schema, tables):
    """FlatBuffers as JSON. flatc writes an enumerator that it does not know as a number."""
    for i, table in enumerate(tables):
        (work / f"{schema}-{i}.bin").write_bytes(table)
    names = [work / f"{schema}-{i}.bin" for i in range(len(tables))]
    run("flatc", "--json", "--strict-json", "--raw-binary", "--defaults-json", "--root-type", f"zonepack.fb.{ROOTS[schema]}",
        "-o", work, GOLDEN / f"{schema}-1.0.fbs", "--", *names)
    # It writes numbers that are not finite in words of its own.
    plain = lambda text: re.sub(r"(\s-?)inf(?=[,\s])", r"\1Infinity", re.sub(r"(\s)-?nan(?=[,\s])", r"\1NaN", text))
    return [json.loads(plain(name.with_suffix(".json").read_text())) for name in names]


def version_1(content, magic, what):
    need(content[:8] == magic and struct.unpack_from("<H", content, 8)[0] == 1, f"{what}: is not of major version 1")


def chunks_of(work, pack):
    content = pack.read_bytes()
    version_1(content, b"\x89ZPK\r\n\x1a\n", pack.name)
    offset, size = struct.unpack_from("<QQ", content, len(content) - 64)
    index = decode(work, "pack", [content[offset:offset + size]])[0]
    for entry in index["chunks"]:
        if entry["kind"] not in KINDS:
            yield entry["kind"], None
            continue
        need(entry["codec"] in ("Raw", "Lz4"), f"{pack.name}: codec {entry['codec']}")
        stored = content[entry["offset"]:entry["offset"] + entry["stored_size"]]
        if entry["codec"] == "Lz4":
            stored = run("lz4", "-d", "-c", "-q", input=FRAME + struct.pack("<I", len(stored)) + stored + b"\0\0\0\0")
        need(len(stored) == entry["decoded_size"], f"{pack.name}: a chunk of {len(stored)} bytes")
        yield entry["kind"], stored


def scans_in(chunk):
    """Of each scan that begins here: its format, and how many float32 a point has."""
    content = bytes(chunk["bytes"])
    for record in chunk["records"]:
        need(isinstance(record["part"], str), f"a part that 1.0 does not know: {record['part']}")
        columns = chunk["columns"][record["first_column"]:record["first_column"] + record["columns"]]
        for column in columns:
            need(isinstance(column["field"], str) and isinstance(column["codec"], str), f"a column of {column}")
        infos = [column for column in columns if column["field"] == "Info"]
        if record["part"] == "Scan" and record["first_row"] == 0 and infos:
            rows = [column["param"] // 4 for column in columns if column["field"] == "Row"]
            channels = sum(column["field"].startswith("Channel") for column in columns)
            yield struct.unpack_from("<i", content, infos[0]["offset"])[0], rows[0] if rows else channels


def read(work, folder):
    """What a robot of 1.0 sees of a map."""
    content = (folder / "manifest.zpm").read_bytes()
    version_1(content, b"\x89ZPM\r\n\x1a\n", folder)
    size = struct.unpack_from("<I", content, 12)[0]
    manifest = decode(work, "manifest", [content[16:16 + size]])[0]
    seen = {"zones": [zone["name"] for zone in manifest["zones"]], "nodes": sum(len(z["nodes"]) for z in manifest["zones"]),
            "chunks": 0, "unknown": 0, "scans": []}
    cores, bulks = [], []
    for zone in manifest["zones"]:
        for kind, chunk in chunks_of(work, folder / zone["pack"]):
            seen["chunks"] += chunk is not None
            seen["unknown"] += chunk is None
            if chunk is not None:
                (cores if kind == "Core" else bulks).append(chunk)
    signatures = [s for core in decode(work, "core_chunk", cores) for s in core["signatures"]] if cores else []
    need(len([s for s in signatures if not s.get("continued")]) == seen["nodes"], f"{folder}: signatures are missing")
    if bulks:
        for chunk in decode(work, "bulk_chunk", bulks):
            seen["scans"] += scans_in(chunk)
    return seen


def main():
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        database, zones = SOURCE / "tests/data/hospital-small.db", SOURCE / "tests/data/zones.geojson"
        clouds.write_pcd(work / "cloud.pcd", clouds.cloud_of(database)[::40], "binary")
        stella_map.StellaMap(*stella_map.read_rtabmap(database, 12), 1.0, "RGBD").write_msgpack(work / "map.msg", False)
        for source in ("cloud.pcd", "map.msg"):
            run(BIN / "zonepack", "build", "--db", work / source, "--zones", zones, "--out", work / f"packed-{source}")
        cloud = read(work, work / "packed-cloud.pcd")
        need(len(cloud["zones"]) == 24 and cloud["unknown"] == 0, f"cloud: {cloud}")
        need(len(cloud["scans"]) == cloud["nodes"], "a tile has no scan")
        for scan in cloud["scans"]:
            need(scan == (256 + 1 + 2 + 4, 6), f"format, channels: {scan}")  # x, y, z and intensity, rgb, ring
        stella = read(work, work / "packed-map.msg")
        need(stella["nodes"] == 12 and stella["unknown"] == 0, f"stella: {stella}")
        for other in sys.argv[3:]:
            seen = read(work, Path(other))
            print(f"{other}: {len(seen['zones'])} zones, {seen['nodes']} signatures, {seen['chunks']} chunks that 1.0 reads, "
                  f"{seen['unknown']} that it leaves out")
    print("old_reader_test: a reader of version 1.0 reads the maps of today")


if __name__ == "__main__":
    main()
