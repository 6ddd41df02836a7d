#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: pages_test.py BIN SOURCE: the reports of the demo in Chromium, at the widths of a phone, a tablet and a desktop.

What the pages show at a moment is compared with the event log and the true path, not with the pages' own data.
Exits with 77 where there is no Chromium.
"""
import json
import math
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import browser  # noqa: E402

WIDTHS = (360, 768, 1280)
MOMENT = 62.0  # seconds: in H2, with rooms behind still held
HOSTILE = "<img src=x onerror=document.title='hacked'>'&<!--<script>"  # no name holds / or "
HOSTILE_LABEL = "</script><script>document.title='hacked'</script>"
faults = []


def check(holds, what):
    if not holds:
        faults.append(what)


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{command[0]} fails: {done.stderr or done.stdout}")


def make_hostile_reports(binaries, source, folder):
    """The demo again, with a zone whose name and label would break out of a careless page."""
    data = source / "tests/data"
    zones = json.loads((data / "zones.geojson").read_text().replace('"H1"', json.dumps(HOSTILE)))
    for feature in zones["features"]:
        if feature["properties"].get("name") == HOSTILE:
            feature["properties"]["label"] = HOSTILE_LABEL
    (folder / "zones.geojson").write_text(json.dumps(zones))
    run(binaries / "zonepack", "build", "--db", data / "hospital-small.db", "--zones", folder / "zones.geojson",
        "--out", folder / "map")
    run(binaries / "zonepack", "report", folder / "map", "--out", folder / "map.html")
    drive = data / "scenario1_loop"
    run(binaries / "zoned", "replay", "--config", source / "config/agilex.yaml", "--map", folder / "map", "--can",
        drive / "can0.log", "--corrections", drive / "corrections.txt", "--report", folder / "report.html")


class Truth:
    """What the run's own files say, apart from the report."""

    def __init__(self, demo, source):
        self.events = [json.loads(line) for line in (demo / "events.jsonl").read_text().splitlines()]
        drive = source / "tests/data/scenario1_loop"
        self.start = float(re.match(r"\(([\d.]+)\)", (drive / "can0.log").read_text())[1])
        rows = (line.split() for line in (drive / "base_groundtruth.txt").read_text().splitlines()
                if line[:1].isdigit())
        self.path = [(float(r[0]), float(r[1]), float(r[2])) for r in rows]

    def shades(self, t):
        """The zones in memory and those being loaded."""
        held, loading = set(), set()
        for event in self.events:
            if event["t_ns"] > t * 1e9:
                break
            if event["event"] == "load_started":
                loading.add(event["zone"])
            elif event["event"] == "load_done":
                loading.discard(event["zone"])
                held.add(event["zone"])
            elif event["event"] == "evicted":
                held.discard(event["zone"])
        return [sorted(held), sorted(loading)]

    def loaded(self, t):
        return sum(e["signatures"] for e in self.events if e["event"] == "load_done" and e["t_ns"] <= t * 1e9)

    def place(self, t):
        _, x, y = min(self.path, key=lambda row: abs(row[0] - self.start - t))
        return x, y


def check_widths(page, path, fragment=""):
    for width in WIDTHS:
        for dark in (False, True):
            where = f"{path.parent.name}/{path.name}{fragment} at {width} px{', dark' if dark else ''}"
            page.open(path, width, dark=dark, fragment=fragment)
            needs = page.value("document.scrollingElement.scrollWidth")
            check(needs <= width, f"{where}: scrolls sideways, {needs} px wide")
            check(page.value("innerWidth") == width, f"{where}: the browser made the page another width")
            check(page.value("document.body.scrollWidth") <= width, f"{where}: the body is wider")
            small = page.value(SMALLEST_TEXT)
            check(small >= 5.5, f"{where}: text of a drawing is {small} px high")
            out = page.value(OUTSIDE.replace("WIDTH", str(width)))
            check(not out, f"{where}: reaches over the edge: {out}")
            contrast = page.value(CONTRAST)
            check(contrast >= 4.5, f"{where}: contrast of text is {contrast}")
            page_is_dark = page.value("getComputedStyle(document.body).backgroundColor") != "rgb(255, 255, 255)"
            check(page_is_dark == dark, f"{where}: the page is not as the system asks")
    check(not page.complaints, f"{path}: {page.complaints}")
    page.complaints.clear()


# The least height, in pixels of the screen, of text in drawings that are shown.
SMALLEST_TEXT = """Math.min(...Array.from(document.querySelectorAll('svg text')).filter(t => t.getClientRects().length)
  .map(t => parseFloat(t.getAttribute('font-size')) * t.getScreenCTM().a))"""
# Elements beyond the edge that no box of their own scrolls.
OUTSIDE = """Array.from(document.querySelectorAll('main *, .bar *')).filter(e => !e.closest('.table, svg, .list') &&
  e.getBoundingClientRect().right > WIDTH + 0.5).map(e => e.tagName + ' ' + e.className).slice(0, 3)"""
# The least contrast (WCAG 2.1) of a drawing's and a page's texts with the page; text on a block of colour has its own.
CONTRAST = """(() => {
  const light = c => c.match(/[\\d.]+/g).slice(0, 3).map(v => v / 255)
    .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const page = light(getComputedStyle(document.body).backgroundColor);
  const contrast = c => { const l = light(c); return (Math.max(l, page) + 0.05) / (Math.min(l, page) + 0.05); };
  const texts = Array.from(document.querySelectorAll('svg text:not(.on):not([font-weight])'))
    .map(t => getComputedStyle(t).fill);
  const words = Array.from(document.querySelectorAll('h1, h2, p, dt, dd, small, td, th, footer'))
    .map(t => getComputedStyle(t).color);
  return Math.min(...texts.concat(words).map(contrast));
})()"""
OUTPUT = "document.querySelector('.bar output').textContent"
SHADES = """['held', 'loading'].map(shade => [...new Set([...document.querySelectorAll('[data-zone].' + shade)]
  .map(e => JSON.parse(document.getElementById('data').textContent).figures[0].zones[e.dataset.zone]))].sort())"""


def seconds(page):
    return float(page.value(OUTPUT).split(" s")[0])


def check_moment(page, report, truth, width):
    """A link to a moment puts the robot, the shades and the values where the run's files say."""
    page.open(report, width, fragment=f"#t={MOMENT:g}")
    at = page.value("""(() => { const svg = [...document.querySelectorAll('.drawing > svg[data-plan]')]
      .find(s => s.getClientRects().length);
      return [svg.dataset.plan, svg.querySelector('.robot').getAttribute('transform'),
        svg.querySelector('.robot').getAttribute('visibility')]; })()""")
    a, b, c, d, e, f = map(float, at[0].split())
    x, y = truth.place(MOMENT)
    shown = [float(n) for n in re.match(r"translate\((\S+) (\S+)\)", at[1]).groups()]
    off_m = math.dist(shown, (a * x + c * y + e, b * x + d * y + f)) / math.hypot(a, b)
    check(at[2] == "visible", f"at {width} px: the robot is not shown")
    check(off_m < 0.1, f"at {width} px: the robot is drawn {off_m:.2f} m from where it was")
    shades = page.value(SHADES)
    check(shades == truth.shades(MOMENT), f"at {width} px: shaded {shades}, in memory {truth.shades(MOMENT)}")
    loaded = page.value("document.querySelector('.timed .values').textContent")
    check(f"Zonepack loaded {truth.loaded(MOMENT)}R" in loaded.replace("Zonepack unloaded", "R"),
          f"at {width} px: '{loaded}' does not say {truth.loaded(MOMENT)} loaded")
    check(seconds(page) == MOMENT, f"at {width} px: the bar says {page.value(OUTPUT)}")


def plot_point(page, chart, share):
    """A point of a chart's plot on the screen, after scrolling to it."""
    return page.value(f"""(() => {{ const svg = [...document.querySelectorAll('.timed')[{chart}]
      .querySelectorAll('svg')].find(s => s.getClientRects().length);
      svg.scrollIntoView({{block: 'center'}});
      const box = svg.getBoundingClientRect(), p = svg.dataset.plot.split(' ').map(Number);
      const scale = box.width / svg.viewBox.baseVal.width;
      return [box.left + (p[0] + p[2] * {share}) * scale, box.top + (p[1] + p[3] / 2) * scale, p[4]]; }})()""")


def check_hand(page, report, truth):
    """Mouse, keys, the list and the play button move the same cursor."""
    page.open(report, 1280)
    x, y, duration = plot_point(page, 2, 0.25)
    page.mouse("Moved", x, y)
    passing = page.value("[...document.querySelectorAll('.values > b')].map(b => b.textContent)")
    check(len(passing) == 4 and len(set(passing)) == 1 and abs(float(passing[0].split()[0]) - duration / 4) < 0.5,
          f"pointing at a quarter of {duration} s shows {passing} in the charts")
    check("press play" in page.value(OUTPUT), "pointing at a chart already moves the robot")
    page.mouse("Pressed", x, y, "left")
    check(abs(seconds(page) - duration / 4) < 0.5, f"a press at a quarter sets {page.value(OUTPUT)}")
    x, y, _ = plot_point(page, 2, 0.5)
    page.mouse("Moved", x, y, "left")
    page.mouse("Released", x, y, "left")
    check(abs(seconds(page) - duration / 2) < 0.5, f"dragging to the middle sets {page.value(OUTPUT)}")
    check(page.value("location.hash").startswith("#t="), "the address does not name the moment")

    before, robot = seconds(page), page.value("document.querySelector('.robot').getAttribute('transform')")
    page.key("ArrowRight")
    page.key("ArrowRight", modifiers=8)  # shift
    check(abs(seconds(page) - before - 11) < 0.11, f"arrows: from {before} to {page.value(OUTPUT)}")
    check(robot != page.value("document.querySelector('.robot').getAttribute('transform')"), "the robot stands still")

    evicted = [e for e in truth.events if e["event"] == "evicted"]
    page.value("""(() => { const s = document.querySelector('.filter select');
      s.value = [...s.options].find(o => o.textContent.startsWith('evicted ')).value;
      s.dispatchEvent(new Event('change')); })()""")
    rows = page.value("[...document.querySelectorAll('.list [role=option]')].map(r => r.textContent)")
    check([r.split("evicted")[1] for r in rows] == [e["zone"] for e in evicted], f"evicted: {rows}")
    page.value("document.querySelectorAll('.list [role=option]')[1].click()")
    check(abs(seconds(page) - evicted[1]["t_ns"] * 1e-9) < 0.06, f"a press on an event sets {page.value(OUTPUT)}")
    shades, known = page.value(SHADES), truth.shades(evicted[1]["t_ns"] * 1e-9 + 1e-6)
    check(shades == known, f"from the list: shaded {shades}, in memory {known}")
    # In the middle of a load.
    started = next(e for e in truth.events if e["event"] == "load_started" and e["zone"] == "C3")
    page.value(f"location.hash = '#t={started['t_ns'] * 1e-9 + 0.001:.3f}'")
    page.value("new Promise(done => setTimeout(done, 100))")
    shades, known = page.value(SHADES), truth.shades(started["t_ns"] * 1e-9 + 0.001)
    check(shades == known and known[1] == ["C3"], f"during a load: shaded {shades}, in memory {known}")

    before = seconds(page)
    page.value("document.querySelector('.bar button').click()")
    page.value("new Promise(done => setTimeout(done, 700))")
    page.value("document.querySelector('.bar button').click()")
    after = seconds(page)
    page.value("new Promise(done => setTimeout(done, 200))")
    check(after > before + 0.5, f"playing goes from {before} to {after} s")
    check(seconds(page) == after, "a pause goes on")
    page.key("Escape")
    check(not page.value("document.body.classList.contains('moving')"), "escape leaves the cursor")

    page.value("document.querySelector('.theme').click()")
    check(page.value("getComputedStyle(document.body).backgroundColor") != "rgb(255, 255, 255)", "the button darkens nothing")
    page.value("document.querySelector('.theme').click()")


def check_paper(page, report):
    page.open(report, 1280, dark=True, fragment=f"#t={MOMENT:g}")
    page.call("Emulation.setEmulatedMedia", media="print", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    page.value("dispatchEvent(new Event('beforeprint'))")
    check(page.value("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)", "paper is dark")
    check(page.value("getComputedStyle(document.querySelector('svg text')).fill") == "rgb(31, 36, 43)", "ink is pale")
    for part in (".bar", "aside", ".theme", ".robot"):
        check(page.value(f"document.querySelector('{part}').getClientRects().length") == 0, f"{part} is printed")
    check(not page.value("document.body.classList.contains('moving')"), "paper shows one moment only")


def check_without_script(page, path):
    for width in WIDTHS:
        page.open(path, width, script=False)
        layout = page.call("Page.getLayoutMetrics")["cssContentSize"]
        check(layout["width"] <= width, f"{path.name} at {width} px without script: {layout['width']} px wide")
        # The page's drawings, as the protocol sees them: one of each pair has a box.
        document = page.call("DOM.getDocument", depth=0)["root"]["nodeId"]
        drawings = page.call("DOM.querySelectorAll", nodeId=document, selector=".drawing > svg")["nodeIds"]
        shown = 0
        for node in drawings:
            try:
                shown += page.call("DOM.getBoxModel", nodeId=node)["model"]["width"] > 200
            except RuntimeError:  # it has no box
                pass
        check(shown == len(drawings) / 2, f"{path.name} at {width} px without script: {shown} drawings are shown")


def check_map(page, path):
    page.open(path, 360)
    page.value("document.querySelector('tbody tr').click()")
    line = page.value("document.querySelector('.values').textContent")
    name = page.value("document.querySelector('tbody tr td').textContent")
    check(line.startswith(name) and "charged" in line, f"a press on the row of {name} shows '{line}'")
    column = page.value("""(() => { const heads = [...document.querySelectorAll('th')];
      const column = heads.findIndex(h => h.textContent.startsWith('Charged'));
      heads[column].querySelector('button').click();
      return [...document.querySelectorAll('tbody tr')].map(r => r.cells[column].textContent); })()""")
    numbers = [float(re.sub(r"[^\d.]", "", text)) for text in column]
    check(numbers == sorted(numbers, reverse=True) and len(numbers) == 24, f"sorted by charged: {numbers}")


def check_hostile(page, folder):
    for name in ("report.html", "map.html"):
        page.open(folder / name, 1280, fragment="#t=30")
        check("hacked" not in page.value("document.title"), f"{name}: a zone's name was run")
        check(page.value(f"document.body.innerText.includes({json.dumps(HOSTILE)})"), f"{name}: the name is not shown whole")
    check(page.value(f"document.body.innerText.includes({json.dumps(HOSTILE_LABEL)})"), "the label is not shown whole")
    page.open(folder / "report.html", 1280, fragment="#t=30")
    check(HOSTILE in page.value(OUTPUT), f"the bar says {page.value(OUTPUT)}")
    check(not page.complaints, f"hostile names: {page.complaints}")


def main():
    binaries, source = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    program = browser.find()
    if program is None:
        print("NOT TESTED: there is no Chromium here: apt-get install chromium")
        return 77
    folder = Path(tempfile.mkdtemp(prefix="zonepack-pages-"))
    try:
        demo, hostile = folder / "demo", folder / "hostile"
        hostile.mkdir()
        run(source / "toolchains/demo.sh", binaries, demo)
        make_hostile_reports(binaries, source, hostile)
        truth = Truth(demo, source)
        with browser.Browser(program) as page:
            for path in (demo / "report.html", demo / "map.html", hostile / "report.html", hostile / "map.html"):
                check_widths(page, path)
            check_widths(page, demo / "report.html", f"#t={MOMENT:g}")
            for width in WIDTHS:
                check_moment(page, demo / "report.html", truth, width)
            check_hand(page, demo / "report.html", truth)
            check_paper(page, demo / "report.html")
            check_map(page, demo / "map.html")
            check_hostile(page, hostile)
            for name in ("report.html", "map.html"):
                check_without_script(page, demo / name)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for text in faults:
        print(text)
    return 1 if faults else 0


sys.exit(main())
