#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: ask_status.py PROTOCOL.FBS SOCKET: prints zoned's status as JSON. Needs flatc (flatbuffers-compiler)."""
import json
import socket
import subprocess
import sys
import tempfile
from pathlib import Path


def convert(schema, root, identifier, content, *options):
    with tempfile.TemporaryDirectory() as folder:
        fbs, source = Path(folder, "protocol.fbs"), Path(folder, "message" + (".bin" if "--json" in options else ".json"))
        fbs.write_text(f'{schema}\nroot_type zonepack.wire.{root};\nfile_identifier "{identifier}";\n')
        source.write_bytes(content)
        subprocess.run(["flatc", *options, "-o", folder, fbs, *(["--"] if "--json" in options else []), source], check=True)
        return Path(folder, "message" + (".json" if "--json" in options else ".bin")).read_bytes()


def ask(zoned, schema, number, kind, **body):
    request = json.dumps({"id": number, "body_type": kind, "body": body}).encode()
    zoned.send(convert(schema, "Request", "ZPQ1", request, "--binary"))
    while True:
        reply = json.loads(convert(schema, "Reply", "ZPA1", zoned.recv(16384), "--json", "--strict-json"))
        if reply.get("id", 0) == number:  # 0: a notice
            return reply


schema = Path(sys.argv[1]).read_text()
with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as zoned:
    zoned.settimeout(5)
    zoned.connect(sys.argv[2])
    ask(zoned, schema, 1, "Hello", version=1, client="ask_status.py")
    print(json.dumps(ask(zoned, schema, 2, "AskStatus")["body"]))
