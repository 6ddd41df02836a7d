#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: partition_picture.py WORK TRUTH OUT.svg: what one drive loads of a building that is parted in four ways.

WORK is partitions.sh's own folder, TRUTH the drive's base_groundtruth.txt. A plan for each partition: zones that the
robot entered, zones that were loaded and never entered, the route. Colors are those of our reports
(runtime/report/page/page.css), light or dark as the reader's system is.
"""
import json
import sys
from pathlib import Path

PANELS = (("drawn", "rooms, drawn by hand"), ("suggested-15m", "rooms, suggest-zones --max-length 15"),
          ("grid-10m", "squares of 10 m"), ("grid-5m", "squares of 5 m"))
MISSION = "scenario1_loop"
WIDTH, PLAN, GAP, TOP = 260, 320, 16, 64  # of a panel, of the plan in it
STYLE = """<style>
text { fill: #1f242b } .quiet { fill: #5c6570 } .page { fill: #ffffff } .route { stroke: #1f242b; fill: none }
path { stroke: #8a939e; stroke-width: .7 } .none { fill: #eef0f3 } .entered { fill: #9cc7ea } .passed { fill: #f2b27a }
@media (prefers-color-scheme: dark) {
text { fill: #e6e9ed } .quiet { fill: #a5aeb9 } .page { fill: #13161b } .route { stroke: #e6e9ed }
path { stroke: #6d7783 } .none { fill: #20252d } .entered { fill: #1f5f92 } .passed { fill: #9a5a1c } }
</style>"""


def rings(geometry):
    polygons = geometry["coordinates"] if geometry["type"] == "MultiPolygon" else [geometry["coordinates"]]
    return [ring for polygon in polygons for ring in polygon]


def zones_of(file):
    """Zones by name; portals have no outline."""
    features = json.loads(file.read_text(encoding="utf-8"))["features"]
    return {feature["properties"]["name"]: rings(feature["geometry"]) for feature in features
            if "Polygon" in feature["geometry"]["type"]}


def text(x, y, words, size=12, kind=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" class="{kind}">{words}</text>'


def panel(work, name, words, route, box, left):
    events = [json.loads(line) for line in
              (work / f"{name}-{MISSION}-smallest.jsonl").read_text(encoding="utf-8").splitlines()]
    summary = json.loads((work / f"{name}-{MISSION}-smallest.json").read_text(encoding="utf-8"))
    entered = {event["zone"] for event in events if event["event"] == "zone_entered"}
    loaded = {event["zone"] for event in events if event["event"] == "load_done"}
    scale = PLAN / (box[3] - box[1])

    def line(ring):
        """Without the points that nobody sees."""
        kept = []
        for x, y in ring:
            at = left + (x - box[0]) * scale, TOP + 40 + (box[3] - y) * scale
            if not kept or max(abs(at[0] - kept[-1][0]), abs(at[1] - kept[-1][1])) > 0.7:
                kept.append(at)
        return " ".join(f"{x:.1f},{y:.1f}" for x, y in kept)

    out = [text(left, TOP, words, 13), text(left, TOP + 17, f"{summary['zones_loaded']} loads, "
           f"{summary['bytes_loaded'] / 2**20:.1f} MiB in a budget of {summary['budget_bytes'] / 2**20:.2f}", 12, "quiet")]
    zones = zones_of(work / f"{name}.geojson")
    for zone, outline in zones.items():
        kind = "entered" if zone in entered else "passed" if zone in loaded else "none"
        lines = " ".join(f"M{line(ring)}Z" for ring in outline)
        out.append(f'<path class="{kind}" fill-rule="evenodd" d="{lines}"><title>{zone}</title></path>')
    out.append(f'<polyline class="route" stroke-width="1.5" points="{line(route)}"/>')
    missing = (entered | loaded) - set(zones)
    if missing:
        sys.exit(f"{work / name}.geojson: no zone {', '.join(sorted(missing))}, which the drive knows; run partitions.sh anew")
    return out


def main():
    if len(sys.argv) != 4:
        print(__doc__.split("\n", maxsplit=1)[0], file=sys.stderr)
        sys.exit(2)
    work = Path(sys.argv[1])
    rows = (line.split() for line in Path(sys.argv[2]).read_text(encoding="ascii").splitlines() if line[:1] != "#")
    route = [(float(row[1]), float(row[2])) for row in rows][::5]
    points = [point for outline in zones_of(work / "drawn.geojson").values() for ring in outline for point in ring]
    box = (min(p[0] for p in points), min(p[1] for p in points), max(p[0] for p in points), max(p[1] for p in points))
    width, height = GAP + len(PANELS) * (WIDTH + GAP), TOP + 40 + PLAN + GAP
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
           f'viewBox="0 0 {width} {height}" font-family="DejaVu Sans, Verdana, sans-serif">', STYLE,
           f'<rect class="page" width="{width}" height="{height}"/>']
    plans = [panel(work, name, words, route, box, GAP + i * (WIDTH + GAP)) for i, (name, words) in enumerate(PANELS)]
    x = GAP
    for kind, words in (("entered", "entered by the robot"), ("passed", "loaded, never entered"), ("none", "never loaded")):
        if any(f'class="{kind}"' in part for plan in plans for part in plan):
            out += [f'<rect class="{kind}" x="{x}" y="16" width="14" height="14"/>', text(x + 20, 28, words)]
            x += 40 + 8 * len(words)
    out += [part for plan in plans for part in plan]
    Path(sys.argv[3]).write_text("\n".join(out) + "\n</svg>\n", encoding="utf-8")


main()
