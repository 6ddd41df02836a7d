# SPDX-License-Identifier: Apache-2.0
"""The picture of memory_and_fixes.py: right fixes over memory, in the colors of our reports (runtime/report/page/page.css),
light or dark as the reader's system is.
"""
import math

WIDTH, HEIGHT = 940, 470
LEFT, RIGHT, TOP, BOTTOM = 64, 24, 84, 56
LEAST, MOST = 16, 2048  # MiB
STYLE = """<style>
text { fill: #1f242b } .quiet { fill: #5c6570 } .ground { fill: #ffffff } .grid { stroke: #e3e6ea } .axis { stroke: #8a939e }
.hospital { stroke: #0b5fa5; fill: #0b5fa5 } .hospital-small { stroke: #3ba78f; fill: #3ba78f }
.line { fill: none } .hollow { fill: #ffffff }
@media (prefers-color-scheme: dark) {
text { fill: #e6e9ed } .quiet { fill: #a5aeb9 } .ground { fill: #13161b } .grid { stroke: #2b313a } .axis { stroke: #6d7783 }
.hospital { stroke: #6db8f5; fill: #6db8f5 } .line { fill: none } .hollow { fill: #13161b } }
</style>"""


def at(mib, share):
    x = LEFT + (WIDTH - LEFT - RIGHT) * math.log(mib / LEAST) / math.log(MOST / LEAST)
    return x, HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share


def text(x, y, words, size=12, anchor="start", kind=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" class="{kind}">{words}</text>'


def line(points, kind):
    places = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline class="line {kind}" stroke-width="2.5" points="{places}"/>'


def mark(x, y, row, ours):
    """A disk is Zonepack, a square RTAB-Map; the loop is filled, the round trip hollow."""
    kind = row["map"] + ("" if row["mission"] == "scenario1_loop" else " hollow")
    hint = f"<title>{row['bytes'] / 2**20:.0f} MiB, {row['share'] * 100:.1f} % right, {row['wrong']} wrong</title>"
    if ours:
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" stroke-width="1.5" class="{kind}">{hint}</circle>'
    return f'<rect x="{x - 4:.1f}" y="{y - 4:.1f}" width="8" height="8" stroke-width="1.5" class="{kind}">{hint}</rect>'


def legend():
    x, out = LEFT, []
    for name, words, mission, ours in (
            ("hospital", "Zonepack, 1095 signatures, loop", "scenario1_loop", True),
            ("hospital", "round trip", "", True), ("hospital-small", "185 signatures, loop", "scenario1_loop", True),
            ("hospital-small", "round trip", "", True), ("hospital", "RTAB-Map, 1095", "scenario1_loop", False),
            ("hospital-small", "RTAB-Map, 185", "scenario1_loop", False)):
        example = {"map": name, "mission": mission, "bytes": 0, "share": 0, "wrong": 0}
        out += [mark(x + 5, 60, example, ours), text(x + 14, 64, words)]
        x += 30 + 7 * len(words)
    return out


def draw(measured, recorded):
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" '
           'font-family="DejaVu Sans, Verdana, sans-serif">', STYLE, f'<rect class="ground" width="{WIDTH}" height="{HEIGHT}"/>',
           text(LEFT, 30, "Images with a right fix, over the memory of the whole localizer; a line is a map's budgets, "
                          "from the smallest to the whole", 14), *legend()]
    for percent in range(0, 101, 20):
        (x, y), (end, _) = at(LEAST, percent / 100), at(MOST, 0)
        out.append(f'<line class="{"grid" if percent else "axis"}" x1="{x}" y1="{y:.1f}" x2="{end:.1f}" y2="{y:.1f}"/>')
        out.append(text(x - 8, y + 4, f"{percent} %" if percent else "0", 11, "end", "quiet"))
    mib = LEAST
    while mib <= MOST:
        x, y = at(mib, 0)
        out.append(f'<line class="axis" x1="{x:.1f}" y1="{y}" x2="{x:.1f}" y2="{y + 4}"/>')
        out.append(text(x, y + 18, f"{mib}", 11, "middle", "quiet"))
        mib *= 2
    out.append(text(WIDTH - RIGHT, HEIGHT - 16, "resident at most, MiB", 11, "end", "quiet"))
    for name, mission in sorted({(row["map"], row["mission"]) for row in measured}):
        rows = [row for row in measured if (row["map"], row["mission"]) == (name, mission)]  # by budget
        points = [at(row["bytes"] / 2**20, row["share"]) for row in rows]
        out += [line(points, name), *(mark(*point, row, True) for point, row in zip(points, rows))]
    out += [mark(*at(row["bytes"] / 2**20, row["share"]), row, False) for row in recorded]
    return "\n".join(out) + "\n</svg>\n"
