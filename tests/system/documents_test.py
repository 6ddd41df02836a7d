#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: documents_test.py SOURCE BIN: every Markdown document names what exists.

Files and headings (links, and paths that begin with a folder of the repository), options (against --help of the
programs in BIN and of toolchains/run), settings (against config/SETTINGS.md, which a unit test holds to the code), and
the version (CHANGELOG.md against CMakeLists.txt).
"""
import os
import re
import subprocess
import sys
from pathlib import Path

PROGRAMS = ("zonepack", "zoned", "zonectl", "zoneloc")
# Programs of others, whose options stand in our documents too.
FOREIGN_PROGRAMS = ("apt-get", "candump", "cmake", "ctest", "flatc", "git", "groupadd", "rsync", "systemctl")
# Files of the kernel that look like settings.
FOREIGN_KEYS = ("memory.max", "memory.high", "memory.current", "memory.peak", "memory.events", "memory.stat")
FLAG = re.compile(r"(?<![\w-])--[a-z][a-z0-9-]*")

faults = []


def files_of(root):
    for folder, names, files in os.walk(root):
        names[:] = [n for n in names if n not in (".git", ".cache") and not n.startswith("build")]
        yield from (Path(folder) / name for name in files)


def help_of(*command):
    run = subprocess.run([*command, "--help"], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} --help fails: {run.stderr}")
    return run.stdout


def known_options(root, binaries):
    """Of "program" and of "program subcommand": the options in its help."""
    options = {"toolchains/run": set(FLAG.findall(help_of(root / "toolchains/run")))}
    for program in PROGRAMS:
        text = help_of(binaries / program)
        options[program] = set(FLAG.findall(text)) | {"--help"}
        subcommands = text.split("\nSubcommands:\n")[1] if "\nSubcommands:\n" in text else ""
        for name in re.findall(r"^  ([a-z-]+) ", subcommands, re.MULTILINE):
            options[f"{program} {name}"] = set(FLAG.findall(help_of(binaries / program, name))) | options[program]
    return options


def known_keys(root):
    """Patterns of all settings, and the names of the top sections."""
    keys, section = [], ""
    for line in (root / "config/SETTINGS.md").read_text().splitlines():
        if line.startswith("## "):
            section = line[3:].strip()
            keys.append(section)
        row = re.match(r"\| ([a-z_]+) \|", line)
        if row and section and row[1] != "key":
            keys.append(f"{section}.{row[1]}")
    patterns = [re.compile(re.sub(r"\b[A-Z]+\b", r"[^.]+", key.replace(".", r"\.")) + r"\Z") for key in keys]
    return patterns, {key.split(".")[0] for key in keys}


def slug(heading):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower().replace("`", "")).replace(" ", "-")


def headings(path):
    return {slug(h) for h in re.findall(r"^#+ (.*)$", path.read_text(), re.MULTILINE)}


def check_links(path, text, fault):
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        file = path.parent / name if name else path
        if not file.exists():
            fault(f"links to {target}, which does not exist")
        elif anchor and file.suffix == ".md" and anchor not in headings(file):
            fault(f"links to {target}: {file.name} has no such heading")


def check_paths(root, text, spans, files, fault):
    tops = "|".join(re.escape(p.name) for p in root.iterdir() if p.is_dir() and not re.match(r"build|\.git$", p.name))
    for name in re.findall(rf"(?<![\w/.$-])(?:{tops})/[\w./*-]*", text):
        name = name.rstrip(".")
        if not any(root.glob(name.rstrip("/"))):
            fault(f"names {name}, which does not exist")
    for name in spans:  # the end of a path, where the text says of what folder it speaks
        if re.fullmatch(r"[a-z][\w-]*(/[\w.-]+)*/[\w-]+\.[a-z]+", name) and not re.match(rf"({tops})/|build/", name):
            if not any(str(file).endswith("/" + name) for file in files):
                fault(f"names {name}, which does not exist anywhere")


def code_of(text):
    """Commands and spans in code, each one line, and the text without them."""
    text = text.replace("\\\n", " ")
    blocks = re.findall(r"^```.*?\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    text = re.sub(r"^```.*?\n.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    code = [line for block in blocks for line in block.splitlines()] + re.findall(r"^(?: {4,}|\t)(.*)$", text, re.MULTILINE)
    text = re.sub(r"^(?: {4,}|\t).*$", "", text, flags=re.MULTILINE)
    spans = [span.replace("\n", " ") for span in re.findall(r"`([^`]+)`", text)]
    return code, spans, re.sub(r"`[^`]+`", "", text)


def check_options(code, prose, options, commands, fault):
    every = set().union(*options.values())
    for line in code:
        for part in re.split(r"\s(?:&&|\|\|?|;)\s|\s#\s", line):
            words = part.split()
            known = every
            for place, word in enumerate(words):
                name = word.rsplit("/", 1)[-1]
                if name in FOREIGN_PROGRAMS:
                    known = None
                elif word == "toolchains/run" or (place == 0 and word in commands):
                    known = options["toolchains/run"]
                elif name in PROGRAMS:
                    following = words[place + 1] if place + 1 < len(words) else ""
                    known = options.get(f"{name} {following}", options[name])
                for flag in FLAG.findall(word) if word.startswith("-") and known is not None else ():
                    if flag not in known:
                        fault(f"names {flag} in '{part.strip()}', which has no such option")
    for flag in FLAG.findall(prose):
        if flag not in every:
            fault(f"names {flag}, an option that no program has")


def check_keys(spans, patterns, sections, fault):
    for span in spans:
        if re.fullmatch(r"[a-z_]+(\.[A-Za-z_]+)+", span) and span.split(".")[0] in sections:
            if span not in FOREIGN_KEYS and not any(pattern.match(span) for pattern in patterns):
                fault(f"names the setting {span}, which does not exist")


def check_version(root):
    """The newest heading with a number in CHANGELOG.md is project(VERSION); only one above it may have none."""
    version = re.search(r"project\(zonepack VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]
    names = re.findall(r"^## (.*)$", (root / "toolchains/CHANGELOG.md").read_text(), re.MULTILINE)
    if names[:1] == ["Unreleased"]:
        names.pop(0)
    if names[:1] != [version]:
        faults.append(f"toolchains/CHANGELOG.md: the newest version is {names[:1]}, not {version} of CMakeLists.txt")


def main():
    root, binaries = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    options = known_options(root, binaries)
    commands = set(re.findall(r"^  ([a-z]+)", help_of(root / "toolchains/run"), re.MULTILINE))
    patterns, sections = known_keys(root)
    count = 0
    files = sorted(files_of(root))
    for path in (file for file in files if file.suffix == ".md"):
        text = path.read_text()
        where = path.relative_to(root)

        def fault(what, where=where):
            faults.append(f"{where} {what}")

        code, spans, prose = code_of(text)
        check_links(path, text, fault)
        check_paths(root, text, spans, files, fault)
        check_options(code + spans, prose, options, commands, fault)
        check_keys(spans, patterns, sections, fault)
        count += 1
    check_version(root)
    for text in faults:
        print(text)
    if not count:
        print("no documents found")
    return 1 if faults or not count else 0


sys.exit(main())
