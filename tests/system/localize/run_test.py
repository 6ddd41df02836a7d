#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: run_test.py BIN SOURCE: zoneloc run beside a zoned that plays the log of a robot that stands still in the
sample map: images of a folder and of a socket, bad ones among them, a zoned that ends and another that begins. The
images are those of the database, which are half as large as those its features are of: they give no fixes.
"""
import json
import os
import shutil
import signal
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from black_png import black_png

BIN, SOURCE = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
DATABASE = SOURCE / "tests/data/hospital-small.db"
WIDTH, HEIGHT = 320, 240  # of the images in the database
CALIBRATION = """%YAML:1.0
---
image_width: 320
image_height: 240
camera_matrix: {rows: 3, cols: 3, data: [192.5, 0, 159.5, 0, 192.5, 119.5, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
local_transform: {rows: 3, cols: 4, data: [0, 0, 1, 0.2, -1, 0, 0, 0, 0, -1, 0, 0.5]}
"""
HERE, ELSEWHERE = 50, 120  # signatures
START_S, LASTS_S = 1000, 40


def fail(what):
    sys.exit(f"run_test: {what}")


def need(holds, what):
    if not holds:
        fail(what)


def of_signature(column, signature):
    with sqlite3.connect(f"file:{DATABASE}?mode=ro", uri=True) as database:
        table = "Data" if column == "image" else "Node"
        return database.execute(f"select {column} from {table} where id = ?", (signature,)).fetchone()[0]


def start_at(signature):
    """X,Y,YAW_DEG of a pose, which is 3 rows of 4 floats."""
    import math
    m = struct.unpack("<12f", of_signature("pose", signature))
    return f"{m[3]:.4f},{m[7]:.4f},{math.degrees(math.atan2(m[4], m[0])):.3f}"


def write_log(file):
    """The first frames of a drive, over and over: the wheels do not turn."""
    frames = [line.split(maxsplit=1)[1] for line in
              (SOURCE / "tests/data/scenario1_loop/can0.log").read_text().splitlines()[:2]]
    with open(file, "w", encoding="ascii") as out:
        for i in range(LASTS_S * 50):
            for k, frame in enumerate(frames):
                out.write(f"({START_S + i * 0.02 + k * 0.0005:.6f}) {frame}\n")


def run(*command, code=0):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False, timeout=120)
    need(done.returncode == code, f"{' '.join(map(str, command))}: exit code {done.returncode}, not {code}: "
                                  f"{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def soon(holds, what, seconds=20):
    """`what` is text, or gives it when it is needed."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if holds():
            return
        time.sleep(0.05)
    fail(what() if callable(what) else what)


class Robot:
    """A zoned that plays the log, with its socket there when this returns."""

    def __init__(self):
        self.process = subprocess.Popen(
            [BIN / "zoned", "run", "--config", SOURCE / "config/agilex.yaml", "--map", "map", "--can", "log:still.log@1",
             "--start", start_at(HERE), "--socket", os.environ["ZONED_SOCKET"], "--allow-degraded", "--quiet"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        soon(lambda: subprocess.run([BIN / "zonectl", "status"], capture_output=True, check=False).returncode == 0,
             "zoned does not answer")

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(30)


class Locating:
    def __init__(self, camera, *more):
        self.log = open("zoneloc.txt", "w+", encoding="utf-8")
        self.process = subprocess.Popen([BIN / "zoneloc", "run", "--calibration", "camera.yaml", "--camera", camera,
                                         "--json", "out.json", *more], stdout=self.log, stderr=self.log)

    def said(self):
        return Path("zoneloc.txt").read_text(encoding="utf-8")

    def says(self, text):
        soon(lambda: text in self.said(), lambda: f"zoneloc does not say '{text}': {self.said()}")

    def end(self, code=0):
        self.process.send_signal(signal.SIGTERM)
        return self.ended(code)

    def ended(self, code=0, seconds=30):
        got = self.process.wait(seconds)
        need(got == code, f"zoneloc: exit code {got}, not {code}: {self.said()}")
        return json.loads(Path("out.json").read_text(encoding="utf-8")) if code == 0 else None


def check_refusals():
    def refused(words, code, *options):
        text = run(BIN / "zoneloc", "run", *options, code=code)
        need(words in text, f"no word of '{words}' in: {text}")
    good = ("--calibration", "camera.yaml")
    refused("is required", 2, *good)
    refused("'usb:0' is not v4l2:DEV, socket:PATH, folder:DIR", 2, *good, "--camera", "usb:0")
    refused("no zoned listens there; start zoned run", 1, *good, "--camera", "folder:images")
    refused("none.yaml", 1, "--calibration", "none.yaml", "--camera", "folder:images")
    robot = Robot()
    refused("none: No such file", 1, *good, "--camera", "folder:none")
    refused("zoned's clock is at", 1, *good, "--camera", "folder:other_day")
    refused("/dev/null: is no video device", 1, *good, "--camera", "v4l2:/dev/null")
    refused("/dev/video99: no such device", 1, *good, "--camera", "v4l2:/dev/video99")
    refused("cannot be made", 1, *good, "--camera", "socket:/nonexistent/camera")
    robot.end()


def check_folder():
    """Images in good order and bad ones among them, each at its second of the run: the last ones late enough for all that
    is asked while the localizer is there."""
    here, elsewhere = of_signature("image", HERE), of_signature("image", ELSEWHERE)
    images = Path("images")
    for second, data in ((4, here), (5, elsewhere), (6, here), (7, here)):
        (images / f"{START_S + second}.5.jpg").write_bytes(data)
    (images / f"{START_S + 16}.5.jpg").write_bytes(here[:len(here) // 2])
    (images / f"{START_S + 17}.5.png").write_bytes(black_png(64, 48))
    robot = Robot()
    zoneloc = Locating("folder:images")
    zoneloc.says("bit for bit")
    time.sleep(1.2)  # reports go out once a second
    status = json.loads(run(BIN / "zonectl", "status", "--json", "-"))
    need(len(status["localizers"]) == 1, f"no localizer in {status}")
    need(status["localizers"][0]["images"] == 3, f"expected 3 images in {status}")
    need("localizer folder:images: fixes of" in run(BIN / "zonectl", "status"), "no localizer in zonectl status")
    need('zoned_localizer_images_total{camera="folder:images"}' in run(BIN / "zonectl", "metrics"), "no metrics")
    result = zoneloc.ended()
    said = zoneloc.said()
    for words in ("bit for bit: the camera repeats itself; nothing is sent", "JPEG that ends early",
                  "an image of 64x48; the calibration is of 320x240"):
        need(words in said, f"zoneloc does not say '{words}': {said}")
    need(result["images"] == 3 and result["refused"] == 3, f"expected 3 images and 3 refused ones: {result}")
    need(result["accepted"] == result["fixes_sent"], f"expected every fix to be taken: {result}")
    need(sum(result["reasons"].values()) + result["accepted"] == 3, f"expected a reason or a fix of each: {result}")
    need(result["reasons"].get("no_pose", 0) == 0, f"expected zoned to have a pose: {result}")
    need(result["rss_peak_bytes"] > 1 << 20, f"no memory in {result}")
    soon(lambda: json.loads(run(BIN / "zonectl", "status", "--json", "-"))["localizers"] == [],
         "a localizer that left is still shown", 5)
    robot.end()


def check_socket():
    """A writer that does well, one that lies, one that stops; then a zoned that ends."""
    def image(data, width=WIDTH, age_s=0.0):
        stamp = time.clock_gettime_ns(time.CLOCK_REALTIME) - int(age_s * 1e9)
        writer.send(struct.pack("<4s4IBBHq", b"ZPI1", len(data), width, HEIGHT, 0, 4, 2, 0, stamp))
        for at in range(0, len(data), 65536):
            writer.send(data[at:at + 65536])
    def connect():
        made = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        made.settimeout(20)
        soon(lambda: os.path.exists("camera.sock"), "no socket for a camera")
        made.connect("camera.sock")
        return made
    here = of_signature("image", HERE)
    robot = Robot()
    zoneloc = Locating("socket:camera.sock")
    writer = connect()
    image(here)
    soon(lambda: '"images":1' in run(BIN / "zonectl", "status", "--json", "-"), "the image is not counted")
    image(of_signature("image", ELSEWHERE), age_s=86400)
    zoneloc.says("behind its clock")
    try:
        image(here, width=640)
    except BrokenPipeError:
        pass  # hung up before the pixels came
    try:
        why = writer.recv(1000)
    except ConnectionResetError:  # the pixels came before it hung up; the reason is still there
        why = writer.recv(1000)
    need(b"the calibration is of 320x240" in why, "the writer is not told why")
    zoneloc.says("the writer was disconnected: an image of 640x240")
    zoneloc.says("no image for 2 s")
    writer = connect()
    image(of_signature("image", ELSEWHERE))
    zoneloc.says("gives images again")
    robot.end()
    zoneloc.says("zoned is gone; waiting for the next")
    image(here)
    robot = Robot()
    zoneloc.says("zoned.sock: connected")
    soon(lambda: json.loads(run(BIN / "zonectl", "status", "--json", "-"))["localizers"], "no localizer after a restart")
    result = zoneloc.end()
    need(result["refused"] == 2 and result["images"] >= 2, f"expected 2 refused images: {result}")
    robot.end()


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.environ["ZONED_SOCKET"] = os.path.join(folder, "zoned.sock")
        Path("camera.yaml").write_text(CALIBRATION, encoding="utf-8")
        for name in ("images", "other_day"):
            os.mkdir(name)
        Path("other_day/1718021600.0.jpg").write_bytes(of_signature("image", HERE))
        write_log("still.log")
        run(BIN / "zonepack", "build", "--db", DATABASE, "--zones", SOURCE / "tests/data/zones.geojson", "--out", "map")
        shutil.copy("other_day/1718021600.0.jpg", "images/1001.0.jpg")
        check_refusals()
        os.remove("images/1001.0.jpg")
        check_folder()
        check_socket()
    print("zoneloc run: images are looked at and counted, what is of no use is named")


main()
