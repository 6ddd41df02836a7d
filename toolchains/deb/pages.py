#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: pages.py BIN OUT: manual pages (OUT/man/*.1) and completions for bash (OUT/completions/*) of the programs in
BIN, made from what their --help prints, which comes from the tables that parse the command line. The files in
toolchains/deb are made by it, and a test holds them to the programs."""

import pathlib
import re
import subprocess
import sys

PROGRAMS = ("zonepack", "zoned", "zonectl", "zoneloc")
FILES = {"FILE", "LOG", "DB", "PATH"}  # what an option takes, and so what completes it
FOLDERS = {"DIR", "MAP"}


class Help:
    """One --help: CLI11's groups of rows, and the examples, which close it."""

    def __init__(self, binary, *words):
        text = subprocess.run([binary, *words, "--help"], check=True, capture_output=True, text=True).stdout
        text, _, examples = text.partition("\nExamples:\n")
        self.examples = [line.strip() for line in examples.splitlines() if line.strip()]
        about, _, rest = text.partition("Usage: ")
        self.about = " ".join(about.split("\n")).strip()
        self.usage, *lines = rest.splitlines()
        self.groups = {}
        rows = []
        for line in lines:
            heading = re.fullmatch(r"(\S.*):", line)
            row = re.match(r"  (\S.*? REQUIRED) (\S.*)$", line) or re.match(r"  (\S.*?)(?:  +(\S.*))?$", line)
            if heading:
                rows = self.groups.setdefault(heading[1], [])
            elif row and not line.startswith("   "):
                rows.append([row[1], row[2] or ""])
            elif line.strip():
                rows[-1][1] = (rows[-1][1] + " " + line.strip()).strip()
        self.commands = {name: Help(binary, *words, name) for name, _ in self.groups.pop("Subcommands", [])}

    def rows(self):
        return [row for rows in self.groups.values() for row in rows]


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")
    return "\\&" + text if text.startswith((".", "\\(aq")) else text


def option_rows(page):
    for term, about in page.rows():
        names, _, takes = term.partition(" ")
        notes = []
        if takes.endswith(" REQUIRED"):
            takes = takes.removesuffix(" REQUIRED")
            notes.append("required")
        bounded = re.fullmatch(r"(\w+):\w+ in \[(\S+) - (\S+)\](?:=(\S+))?", takes)
        if bounded:
            takes = bounded[1]
            notes.append(f"from {bounded[2]} to {bounded[3]}")
            if bounded[4]:
                notes.append(f"default {bounded[4]}")
        about += f" ({'; '.join(notes)})" if notes else ""
        yield ".TP"
        yield f".B {roff(names.replace(',', ', '))}" + (f" \\fI{roff(takes)}\\fR" if takes else "")
        yield roff(about or names)


def example_lines(page):
    if page.examples:
        yield ".nf"
        yield from (roff(line) for line in page.examples)
        yield ".fi"


def manual(name, page, version):
    first, _, rest = page.about.partition(". ")
    exits = rest.partition("Exit codes: ")[2] or "0 done, 1 the input or the world is bad, 2 usage."
    lines = [".\\\" Made by toolchains/deb/pages.py.", f".TH {name.upper()} 1 \"\" \"Zonepack {version}\" \"Zonepack\"",
             ".SH NAME", f"{name} \\- {roff(first[0].lower() + first[1:].rstrip('.'))}", ".SH SYNOPSIS",
             f".B {name}", "\\fICOMMAND\\fR [\\fIOPTIONS\\fR]", ".SH DESCRIPTION", roff(first.rstrip(".") + ".")]
    if rest.partition("Exit codes: ")[0].strip():
        lines.append(roff(rest.partition("Exit codes: ")[0].strip()))
    lines += [".SH OPTIONS", *option_rows(page), ".SH COMMANDS"]
    for word, command in page.commands.items():
        lines += [f".SS {name} {roff(word)}", roff(command.about), ".PP", f"Usage: {roff(command.usage)}"]
        lines += option_rows(command)
        if command.examples:
            lines += [".PP", "Examples:", *example_lines(command)]
    if page.examples:
        lines += [".SH EXAMPLES", *example_lines(page)]
    others = ", ".join(f"\\fB{other}\\fR(1)" for other in PROGRAMS if other != name)
    lines += [".SH EXIT STATUS", roff(exits), ".SH SEE ALSO", others]
    return "\n".join(lines) + "\n"


def completed(pattern, action):
    return f"    {pattern}) {action}; return ;;"


def completion(name, page):
    """Options of the command on the line, and files or folders where an option takes them."""
    def names(term):
        return [word for word in term.split(" ")[0].split(",") if word.startswith("-")]

    taking = {"files": set(), "folders": set(), "other": set()}
    for command in [page, *page.commands.values()]:
        for term, _ in command.rows():
            takes = term.partition(" ")[2].split(":")[0].split(" ")[0]
            if takes:
                kind = "files" if takes in FILES or "." in takes else "folders" if takes in FOLDERS else "other"
                taking[kind].update(names(term))
    taking["other"] -= taking["files"] | taking["folders"]
    taking["folders"] -= taking["files"]
    lines = ["# bash completion of " + name + ". Made by toolchains/deb/pages.py.", f"_{name}() {{",
             "  local word=${COMP_WORDS[COMP_CWORD]} command='' options", "  local -i i",
             "  case ${COMP_WORDS[COMP_CWORD - 1]} in"]
    for kind, action in (("files", 'mapfile -t COMPREPLY < <(compgen -f -- "$word")'),
                         ("folders", 'mapfile -t COMPREPLY < <(compgen -d -- "$word")'), ("other", "COMPREPLY=()")):
        if taking[kind]:
            lines.append(completed(" | ".join(sorted(taking[kind])), action))
    lines += ["  esac", "  for ((i = 1; i < COMP_CWORD; ++i)); do", "    case ${COMP_WORDS[i]} in",
              f"      {' | '.join(page.commands)}) command=${{COMP_WORDS[i]}}; break ;;", "    esac", "  done",
              "  case $command in"]
    own = [option for term, _ in page.rows() for option in names(term)]
    lines.append(f"    '') options='{' '.join([*page.commands, *own])}' ;;")
    for word, command in page.commands.items():
        options = [option for term, _ in command.rows() for option in names(term)]
        lines.append(f"    {word}) options='{' '.join(options)}' ;;")
    lines += ["  esac", '  if [[ -n $command && $word != -* ]]; then mapfile -t COMPREPLY < <(compgen -f -- "$word"); return; fi',
              '  mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")', "}",
              f"complete -o filenames -F _{name} {name}"]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.partition(":")[0] + ": BIN OUT")
    binaries, out = map(pathlib.Path, sys.argv[1:])
    for folder in ("man", "completions"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    for name in PROGRAMS:
        page = Help(binaries / name)
        line = subprocess.run([binaries / name, "--version"], check=True, capture_output=True, text=True).stdout
        (out / "man" / f"{name}.1").write_text(manual(name, page, line.split()[1]))
        (out / "completions" / name).write_text(completion(name, page))


main()
