#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Our DBC reader against canmatrix (Debian: python3-canmatrix): other_reader_test.py DECODE_DBC [FILE.dbc ...]

Every signal of the given files and of 300 made-up messages (all lengths, places, orders, types,
scales, one level of multiplexing), read from random frames, must be the same in both.
Exits 77 when canmatrix is not installed.
"""
import io
import logging
import random
import subprocess
import sys
import tempfile

try:
    logging.disable(logging.CRITICAL)
    import canmatrix.formats
except ImportError:
    print("not run: python3-canmatrix is not installed")
    sys.exit(77)


def made_up_dbc(rng):
    lines = ["VERSION \"\"", "", "NS_ :", "", "BS_:", "", "BU_: N", ""]
    value_types = []
    for i in range(300):
        message_id = i * 6 + rng.randrange(6)  # each its own
        if i % 2:
            message_id = 0x80000000 | rng.randrange(1 << 18) << 11 | message_id
        lines.append(f"BO_ {message_id} M{i}: 8 N")
        multiplexed = i % 5 == 0
        if multiplexed:
            lines.append(' SG_ Mux M : 0|4@1+ (1,0) [0|0] "" N')
        for k in range(4):
            kind = rng.choice(["int"] * 6 + ["float", "double"])
            length = {"float": 32, "double": 64}.get(kind, rng.randint(1, 64))
            if rng.random() < 0.5:
                order, start = 1, rng.randint(0, 64 - length)
            else:
                place = rng.randint(0, 64 - length)
                order, start = 0, place // 8 * 8 + 7 - place % 8
            sign = "-" if kind != "int" else rng.choice("+-")
            factor = rng.choice(["1", "0.001", "-2.5", "1E-05", "0.0174532925"])
            offset = rng.choice(["0", "-40", "12.5", "1e3"])
            mark = f" m{rng.randrange(16)}" if multiplexed else ""
            lines.append(f' SG_ S{k}{mark} : {start}|{length}@{order}{sign} ({factor},{offset}) [0|0] "x;" N')
            if kind != "int":
                value_types.append(f"SIG_VALTYPE_ {message_id} S{k} : {1 if kind == 'float' else 2};")
        lines.append("")
    return "\n".join(lines + ['CM_ "a; \n text";'] + value_types) + "\n"


def theirs(frame, data):
    """What canmatrix decodes; of multiplexed signals only those that are there."""
    values = {}
    for name, decoded in frame.decode(data).items():
        signal = decoded.signal
        value = float(decoded.phys_value)
        if abs(value) != float("inf") and value == value:
            values[name] = value
    return values


def compare(program, path, rng, rounds):
    matrix = canmatrix.formats.loadp_flat(path)
    frames = [(f, bytes(rng.randrange(256) for _ in range(8))) for f in matrix.frames for _ in range(rounds)]
    told = subprocess.run([program, path], text=True, capture_output=True,
                          input="".join(f"{f.name} {d.hex()}\n" for f, d in frames))
    if told.returncode != 0:
        sys.exit(f"{path}: {told.stderr}")
    ours = iter(told.stdout.splitlines())
    count = 0
    for frame, data in frames:
        expected = theirs(frame, data)
        for signal in sorted(expected, key=[s.name for s in frame.signals].index):
            name, value = next(ours).split()
            want = expected[signal]
            if name != f"{frame.name}.{signal}" or abs(float(value) - want) > 1e-9 * max(1.0, abs(want)):
                sys.exit(f"{path}: {frame.name}.{signal} of {data.hex()} is {want}, ours {name} {value}")
            count += 1
    if next(ours, None) is not None:
        sys.exit(f"{path}: we read more signals")
    print(f"{path}: {count} values alike")


def main():
    rng = random.Random(5)
    with tempfile.NamedTemporaryFile("w", suffix=".dbc") as file:
        file.write(made_up_dbc(rng))
        file.flush()
        compare(sys.argv[1], file.name, rng, 20)
    for path in sys.argv[2:]:
        compare(sys.argv[1], path, rng, 20)


main()
