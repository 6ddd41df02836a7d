#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: grid_in_page.py PAGE.html MAP.pgm: the page of a map holds the map's occupancy grid, cell by cell as the image is."""
import base64
import re
import struct
import sys
import zlib
from pathlib import Path


def cells_of_png(content):
    """Width, height and the palette index of each cell, of a PNG with a palette of four colours and no row filters."""
    width, height, depth, colour = struct.unpack(">IIBB", content[16:26])
    assert (depth, colour) == (2, 3), f"{depth} bits, colour type {colour}"
    at, packed = 8, b""
    while at < len(content):
        size, kind = struct.unpack_from(">I4s", content, at)
        if kind == b"IDAT":
            packed += content[at + 8:at + 8 + size]
        at += 12 + size
    rows, row = zlib.decompress(packed), 1 + (width + 3) // 4
    cells = bytearray()
    for y in range(height):
        assert rows[y * row] == 0, f"row {y} is filtered"
        unpacked = bytes(byte >> shift & 3 for byte in rows[y * row + 1:(y + 1) * row] for shift in (6, 4, 2, 0))
        cells += unpacked[:width]
    return width, height, cells


def main():
    page, image = Path(sys.argv[1]).read_text(), Path(sys.argv[2]).read_bytes()
    header = re.match(rb"P5\s(\d+) (\d+)\s255\s", image)
    grids = re.findall(r"data:image/png;base64,([A-Za-z0-9+/=]+)", page)
    assert grids, "no picture in the page"
    for grid in grids:
        width, height, cells = cells_of_png(base64.b64decode(grid))
        assert (width, height) == tuple(map(int, header.groups())), f"{width} x {height} cells in the page"
        drawn = sorted(set(zip(image[header.end():], cells)))  # unknown, free and occupied: a colour each
        assert len(drawn) == len({grey for grey, _ in drawn}) == len({colour for _, colour in drawn}) == 3, drawn


main()
