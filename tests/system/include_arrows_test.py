#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: include_arrows_test.py SOURCE: each folder includes what this table allows, and is one target's.

The table is exact: a folder or an arrow that the sources no longer have fails as well as one they should not have.
An arrow names a folder, or one header of it where a folder may know no more.
"""
import re
import sys
from pathlib import Path

PRODUCTS = ("platform", "runtime", "packer")

ARROWS = {
    "platform/base": "",
    "platform/can": "platform/base platform/files",
    "platform/devices": "platform/base",
    "platform/files": "platform/base",
    "platform/memory": "platform/base platform/files",
    "platform/process": "platform/base platform/files",
    "platform/sim": "platform/base platform/can platform/devices platform/files",
    "platform/linux": "platform/base platform/can platform/devices platform/files platform/memory platform/process",
    "platform/linux/gpiod": "platform/devices platform/process",
    "platform/version": "",
    "platform/command_line": "platform/base",

    "runtime/pack_format": "platform/base",
    "runtime/pack_format/file": "platform/base platform/files runtime/pack_format",
    "runtime/protocol": "platform/base platform/process runtime/pack_format",
    "runtime/client": "platform/base platform/memory runtime/memory/shared_layout.hpp runtime/pack_format"
                      " runtime/protocol",
    "runtime/report": "platform/base platform/files platform/process runtime/pack_format/file",

    "runtime/memory": "platform/base platform/files platform/memory platform/process runtime/pack_format",
    "runtime/odometry": "platform/base platform/can",
    "runtime/zones": "platform/base runtime/odometry runtime/pack_format runtime/pack_format/file",
    "runtime/map": "platform/base platform/files runtime/pack_format runtime/pack_format/file",
    "runtime/control": "platform/base platform/can runtime/map runtime/memory runtime/odometry runtime/pack_format"
                       " runtime/zones",

    "runtime/settings": "platform/base platform/devices platform/files platform/memory runtime/control"
                        " runtime/odometry runtime/pack_format runtime/zones",
    "runtime/run/figures": "platform/base platform/can platform/files platform/memory runtime/control runtime/memory"
                           " runtime/odometry runtime/pack_format runtime/pack_format/file runtime/report",
    "runtime/run/inputs": "platform/base platform/can platform/devices platform/files runtime/control runtime/map"
                          " runtime/odometry runtime/pack_format/file runtime/run/figures runtime/run/maps"
                          " runtime/settings",
    "runtime/run/maps": "platform/base runtime/control runtime/map runtime/memory runtime/pack_format/file"
                        " runtime/zones",
    "runtime/run": "platform/base platform/files runtime/control runtime/memory runtime/pack_format/file"
                   " runtime/report runtime/run/figures runtime/run/inputs runtime/run/maps runtime/zones",
    "runtime/recording": "platform/base platform/files runtime/control runtime/odometry runtime/pack_format"
                         " runtime/pack_format/file runtime/run/inputs runtime/run/maps runtime/zones",
    "runtime/state": "platform/base platform/files platform/process runtime/control runtime/odometry"
                     " runtime/pack_format runtime/pack_format/file runtime/recording",
    "runtime/serve": "platform/base platform/files platform/memory platform/process runtime/control runtime/map"
                     " runtime/memory runtime/odometry runtime/pack_format runtime/pack_format/file runtime/protocol"
                     " runtime/run/figures runtime/settings runtime/zones",
    "runtime/live/bus": "platform/base platform/can platform/files platform/memory platform/process platform/sim"
                        " runtime/live/cycle runtime/odometry runtime/run/inputs runtime/settings",
    "runtime/live/cycle": "platform/base platform/can platform/memory platform/process runtime/control"
                          " runtime/live/messages runtime/map runtime/memory runtime/run/figures runtime/settings",
    "runtime/live/gpio": "platform/base platform/devices platform/memory platform/process runtime/control"
                         " runtime/live/messages runtime/run/figures runtime/settings",
    "runtime/live/messages": "platform/base platform/can platform/files platform/memory platform/process"
                             " runtime/control runtime/run runtime/run/figures",
    "runtime/live": "platform/base platform/can platform/devices platform/files platform/memory platform/process"
                    " runtime/live/bus runtime/live/cycle runtime/live/gpio runtime/live/messages runtime/map"
                    " runtime/memory runtime/pack_format/file runtime/recording runtime/run runtime/run/figures"
                    " runtime/run/inputs runtime/run/maps runtime/serve runtime/settings runtime/state runtime/zones",
    "runtime/replay": "platform/base platform/can platform/sim runtime/control runtime/map runtime/memory"
                      " runtime/odometry runtime/pack_format runtime/recording runtime/run runtime/run/figures"
                      " runtime/run/inputs runtime/run/maps runtime/settings",
    "runtime/evaluate": "platform/base platform/can platform/files platform/process runtime/control"
                        " runtime/evaluate/policies runtime/map runtime/memory runtime/pack_format"
                        " runtime/pack_format/file runtime/recording runtime/replay runtime/report runtime/run"
                        " runtime/run/figures runtime/run/inputs runtime/run/maps runtime/settings",
    "runtime/evaluate/policies": "platform/base runtime/control runtime/memory",
    "runtime/calibrate": "platform/base platform/can platform/files runtime/odometry runtime/run runtime/run/inputs"
                         " runtime/settings",
    "runtime/learn": "platform/base platform/can platform/files runtime/map runtime/pack_format/file runtime/recording"
                     " runtime/replay runtime/run runtime/run/figures runtime/run/inputs runtime/run/maps"
                     " runtime/zones",
    "runtime/listen": "platform/base platform/can platform/files platform/process platform/sim runtime/calibrate"
                      " runtime/live/bus runtime/live/messages runtime/odometry runtime/run/inputs runtime/settings",
    "runtime/localize/replay": "platform/base platform/can platform/files platform/process runtime/client"
                               " runtime/localize/camera runtime/localize/check runtime/localize/features"
                               " runtime/localize/lost runtime/localize/query runtime/map runtime/odometry"
                               " runtime/replay runtime/report runtime/run runtime/run/figures runtime/run/inputs",
    "runtime/zoned": "platform/base platform/command_line platform/memory platform/process platform/version"
                     " runtime/calibrate runtime/evaluate runtime/learn runtime/listen runtime/live runtime/live/bus"
                     " runtime/pack_format/file runtime/recording runtime/replay runtime/report",
    "runtime/ctl/commands": "platform/base platform/files platform/process runtime/control runtime/odometry"
                            " runtime/pack_format/file runtime/protocol runtime/run runtime/serve runtime/settings",
    "runtime/ctl": "platform/command_line platform/process/signals.hpp platform/version runtime/ctl/commands"
                   " runtime/protocol",

    "runtime/localize/camera": "platform/base platform/devices platform/files platform/process"
                               " runtime/pack_format/file runtime/run/figures",
    "runtime/localize/features": "platform/base platform/process runtime/localize/camera",
    "runtime/localize/solve": "runtime/localize/camera runtime/odometry",
    "runtime/localize/query": "platform/base platform/process runtime/client runtime/localize/camera"
                              " runtime/localize/features runtime/localize/solve runtime/map runtime/odometry"
                              " runtime/pack_format runtime/pack_format/file",
    "runtime/localize/lost": "platform/base runtime/control runtime/localize/features runtime/localize/query"
                             " runtime/localize/solve runtime/map runtime/odometry runtime/pack_format"
                             " runtime/pack_format/file",
    "runtime/localize/check": "platform/base runtime/localize/camera runtime/localize/query runtime/localize/solve",
    "runtime/localize/explain": "platform/base platform/files runtime/localize/camera runtime/localize/query"
                                " runtime/localize/solve runtime/map runtime/odometry runtime/report",
    "runtime/localize/run": "platform/base platform/files platform/process runtime/client runtime/localize/camera"
                            " runtime/localize/check runtime/localize/lost runtime/localize/query runtime/odometry"
                            " runtime/protocol runtime/run runtime/run/figures runtime/settings",
    "runtime/localize/zoneloc": "platform/command_line platform/process platform/version runtime/localize/explain"
                                " runtime/localize/replay runtime/localize/run runtime/pack_format/file"
                                " runtime/protocol runtime/report runtime/run/inputs",

    "packer/record": "",
    "packer/align": "packer/record platform/base",
    "packer/sources/cloud": "packer/record runtime/pack_format",
    "packer/sources/sqlite": "packer/record platform/base",
    "packer/sources/nvblox": "packer/record packer/sources/sqlite platform/base runtime/pack_format",
    "packer/sources/rtabmap": "packer/record packer/sources/sqlite platform/base",
    "packer/sources/stella": "packer/align packer/record packer/sources/sqlite platform/base",
    "packer/sources": "packer/record packer/sources/cloud packer/sources/nvblox packer/sources/rtabmap"
                      " packer/sources/stella",
    "packer/outline": "packer/record runtime/pack_format",
    "packer/zones": "platform/base runtime/pack_format runtime/pack_format/file",
    "packer/encode": "packer/record platform/base platform/files runtime/pack_format runtime/pack_format/file",
    "packer/decode": "packer/record platform/base runtime/pack_format runtime/pack_format/file",
    "packer/build": "packer/encode packer/record packer/sources packer/zones platform/base platform/files"
                    " platform/process platform/version runtime/pack_format/file",
    "packer/update": "packer/align packer/build packer/decode packer/encode packer/record packer/sources packer/zones"
                     " platform/base platform/process runtime/pack_format/file",
    "packer/verify": "packer/decode packer/record packer/zones platform/base platform/files runtime/pack_format"
                     " runtime/pack_format/file",
    "packer/export": "packer/decode packer/record platform/base runtime/pack_format",
    "packer/preview": "packer/console packer/decode packer/outline packer/zones platform/base runtime/report",
    "packer/console": "platform/base runtime/pack_format",
    "packer/inspect": "packer/console packer/decode packer/verify platform/base runtime/pack_format/file",
    "packer/suggest": "packer/zones runtime/pack_format",
    "packer/tune": "packer/console packer/decode packer/encode packer/outline packer/preview packer/update"
                   " packer/zones platform/base platform/process runtime/pack_format runtime/pack_format/file"
                   " runtime/report",
    "packer/commands": "packer/build packer/console packer/decode packer/export packer/inspect packer/outline"
                       " packer/preview packer/record packer/sources packer/suggest packer/tune packer/update"
                       " packer/verify packer/zones platform/base platform/command_line platform/files"
                       " platform/process runtime/pack_format runtime/pack_format/file runtime/report",
    "packer": "packer/commands packer/record/source_kind.hpp platform/command_line platform/process/signals.hpp"
              " platform/version runtime/pack_format/file",



}

GPIOD = r"gpiod\.h"
# Headers of the system and of libraries, and the only folders that may include them. A pattern matches from the start.
FOREIGN = {
    r"(linux|asm|net|sys)/": "platform/linux platform/linux/gpiod",
    GPIOD: "platform/linux/gpiod",  # one file, so that another version needs one more
    r"flatbuffers/": "runtime/pack_format",
    r"lz4": "runtime/pack_format/file runtime/recording packer/build packer/encode",
    r"xxhash": "runtime/pack_format/file",
    r"sodium": "runtime/pack_format/file runtime/run",
    r"yaml-cpp/": "packer/outline runtime/settings runtime/live/bus runtime/localize/camera",
    r"Eigen/": "packer/align packer/sources/stella runtime/calibrate runtime/localize/camera runtime/localize/features runtime/localize/solve runtime/localize/query runtime/localize/check",
    r"CLI/": "platform/command_line runtime/zoned runtime/ctl runtime/localize/zoneloc packer packer/commands",
    r"sqlite3\.h": "packer/sources/sqlite packer/export",
    r"zlib\.h": "packer/sources/rtabmap packer/preview",
    r"nlohmann/": "packer/sources/stella packer/commands packer/inspect packer/outline packer/verify packer/zones",
    r"opencv": "runtime/localize/features",
    r"(jpeglib|jerror|png)\.h": "packer/outline runtime/localize/camera runtime/localize/explain",
}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^">]+)[">]', re.MULTILINE)
faults = []


def fault(text):
    faults.append(text)


def folder_of(path):
    return str(Path(path).parent)


def sources_of(root):
    """Of each folder with sources: its files."""
    folders = {}
    for product in PRODUCTS:
        for path in sorted((root / product).rglob("*")):
            if path.suffix in (".hpp", ".cpp", ".h", ".c"):
                folders.setdefault(folder_of(path.relative_to(root)), []).append(path)
    return folders


def check_includes(root, folders):
    used = {folder: set() for folder in folders}
    foreign_used = {pattern: set() for pattern in FOREIGN}
    for folder, files in folders.items():
        allowed = set(ARROWS.get(folder, "").split())
        for path in files:
            where = path.relative_to(root)
            for header in INCLUDE.findall(path.read_text()):
                check_foreign(folder, where, header, foreign_used)
                target = folder_of(header)
                if header.split("/")[0] == "tests":
                    fault(f"{where} includes {header}: products do not include tests")
                elif header.split("/")[0] not in PRODUCTS:
                    if target == "." and (path.parent / header).exists():
                        fault(f"{where} includes {header} without its folder")
                elif target != folder:
                    arrow = header if header in allowed else target
                    used[folder].add(arrow)
                    if arrow not in allowed:
                        fault(f"{where} includes {header}: {folder} may not include {target}")
    for folder, targets in used.items():
        for arrow in set(ARROWS.get(folder, "").split()) - targets:
            fault(f"the table lets {folder} include {arrow}, which it does not")
    for pattern, places in foreign_used.items():
        for place in set(FOREIGN[pattern].split()) - places:
            fault(f"the table lets {place} include {pattern}, which it does not")


def check_foreign(folder, where, header, used):
    for pattern, places in FOREIGN.items():
        if not re.match(pattern, header):
            continue
        if folder in places.split():
            used[pattern].add(folder)
        else:
            fault(f"{where} includes {header}, which is for {places or 'no folder'} only")


def check_tests(root):
    """libgpiod's header stands in one file of the products and in no test."""
    for path in sorted((root / "tests").rglob("*")):
        if path.suffix in (".hpp", ".cpp") and "gpiod.h" in INCLUDE.findall(path.read_text()):
            fault(f"{path.relative_to(root)} includes gpiod.h, which is for {FOREIGN[GPIOD]} only")


def check_table(folders):
    for folder in sorted(set(folders) - set(ARROWS)):
        fault(f"{folder} has sources and is not in the table")
    for folder in sorted(set(ARROWS) - set(folders)):
        fault(f"{folder} is in the table and has no sources")
    done, path = set(), []

    def visit(folder):
        if folder in path:
            fault("the table has a circle: " + " -> ".join(path[path.index(folder):] + [folder]))
        elif folder not in done:
            path.append(folder)
            for arrow in ARROWS.get(folder, "").split():
                visit(folder_of(arrow) if arrow.endswith(".hpp") else arrow)
            path.pop()
            done.add(folder)

    for folder in ARROWS:
        visit(folder)


def check_targets(root, folders):
    """A folder is a library or part of one: CMake names folders, each once, and no files."""
    targets = {}
    listings = [path for product in PRODUCTS for path in sorted((root / product).rglob("CMakeLists.txt"))]
    for path in listings + sorted((root / "toolchains/cmake").glob("*.cmake")):
        where = path.relative_to(root)
        text = re.sub(r"#.*", "", path.read_text())
        for pattern in (r"list\s*\(\s*FILTER", r"\bREGEX\b", r"\bMATCHES\s+\S*\.(?:cpp|hpp)", r"\bGLOB_RECURSE\b"):
            if re.search(pattern, text):
                fault(f"{where} sorts files by a pattern: {pattern}")
        for name in re.findall(r"[\w*.\-]+\.(?:cpp|c|cc)\b", text):
            if name != "*.cpp":
                fault(f"{where} names {name}; a library is made of whole folders")
        for target, dirs in re.findall(r"\bzonepack_(?:library|program)\s*\(\s*(\w+)\s+([^)$]*)\)", text):
            for name in dirs.split():
                folder = str(where.parent / name)
                if folder in targets:
                    fault(f"{folder} is in two targets, {targets[folder]} and {target}")
                targets[folder] = target
    for folder in sorted(set(folders) - set(targets)):
        fault(f"{folder} is in no target")
    for folder in sorted(set(targets) - set(folders)):
        fault(f"target {targets[folder]} names {folder}, which has no sources")


def main():
    root = Path(sys.argv[1])
    folders = sources_of(root)
    check_table(folders)
    check_includes(root, folders)
    check_tests(root)
    check_targets(root, folders)
    for text in faults:
        print(text)
    return 1 if faults else 0


sys.exit(main())
