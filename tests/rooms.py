#!/usr/bin/env python3
# rooms.py - the map of the folders, and how large they are. SPDX-License-Identifier: MIT
"""rooms.py map [ROOM]: folders of kernel and host, what for, the folders they include from; of a ROOM its files, too.
rooms.py check: compares code lines of folders and words of pages with tests/budget.txt.
rooms.py write: writes today's counts of folders and pages into tests/budget.txt; the totals stay.

Code lines are lines without blanks and comments, in all languages. The line table is data and does not count."""

import pathlib
import re
import signal
import sys

BUDGET = pathlib.Path("tests/budget.txt")
PROGRAMMED = {".c", ".h", ".cpp", ".py", ".f90"}
# strings and characters, which may contain what looks like a comment; comments
C_TOKEN = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|/\*.*?\*/|//[^\n]*', re.S)


def code_lines(path):
    text = path.read_text()
    if path.suffix in {".py", ".f90"}:
        text = re.sub(r"^\s*[#!].*", "", text, flags=re.M)
    else:
        text = C_TOKEN.sub(lambda token: token[0] if token[0][0] in "\"'" else "", text)
    return sum(1 for line in text.split("\n") if line.strip())


def sources():
    """Sources of kernel and host by folder; the folder lanes belongs to its parent."""
    rooms = {}
    for tree in ("kernel", "host"):
        for path in sorted(pathlib.Path(tree).rglob("*.*")):
            if path.suffix in PROGRAMMED:
                rooms.setdefault(str(path.parent).removesuffix("/lanes"), []).append(path)
    return rooms


def counts():
    """Totals, and lines or words of each folder and page."""
    lines = {path: code_lines(path) for room in sources().values() for path in room if path.name != "line_table.c"}
    words = {str(page): len(page.read_text().split())
             for page in [pathlib.Path("README.md"), pathlib.Path("CHANGELOG.md"), *sorted(pathlib.Path("docs").glob("*.md"))]}
    c = [path for path in lines if path.suffix in {".c", ".h"}]
    tests = [path for path in pathlib.Path("tests").rglob("*.[ch]")]
    totals = {"code": sum(lines[path] for path in c),
              "other": sum(lines.values()) - sum(lines[path] for path in c),
              "tests": sum(map(code_lines, tests)),
              "words": sum(words.values())}
    rooms = {room: sum(lines.get(path, 0) for path in files) for room, files in sources().items()}
    return totals, {**rooms, **words}


def budget():
    """{name: (number, what for)} as tests/budget.txt has it; no number: None."""
    rows = (line.split(None, 2) for line in BUDGET.read_text().splitlines() if line and line[0] != "#")
    return {row[0]: (None if row[1] == "-" else int(row[1]), row[2] if len(row) > 2 else "") for row in rows}


def check():
    totals, rooms = counts()
    known = budget()
    print(", ".join(f"{name} {number:,} of {known[name][0]:,}" for name, number in totals.items()))
    grown = [f"{name} grew from {known[name][0]} to {number}"
             for name, number in {**totals, **rooms}.items() if name in known and number > (known[name][0] or number)]
    if grown:
        sys.exit("\n".join(grown) + "\nA feature comes in when another goes out: shorten, then `make budget`.")


def write():
    totals, rooms = counts()
    known = budget()
    head = [line for line in BUDGET.read_text().splitlines() if line.startswith("#")]
    rows = [(name, known[name][0], known[name][1]) for name in totals]
    rows += [(name, number, known.get(name, (0, ""))[1]) for name, number in rooms.items()]
    BUDGET.write_text("\n".join(head + [f"{name:32} {number:6} {what}".rstrip() for name, number, what in rows]) + "\n")


def includes_from(room, files):
    """The folders of the same tree that the files of a folder include from."""
    tree, _, name = room.partition("/")
    found = re.findall(r'^#include "([a-z_/]*)/', "\n".join(path.read_text() for path in files), re.M)
    return sorted({folder.removesuffix("/lanes") for folder in found} - {name, tree})


def purpose(path):
    """What the first line of a file says after its name."""
    lines = path.read_text().split("\n", 2)
    line = lines[1] if lines[0].startswith("#!") or "clang-format" in lines[0] else lines[0]
    text = line.partition(" - ")[2].replace("SPDX-License-Identifier: MIT", "").strip(" */")
    return text.partition(". ")[0].rstrip(".")


def print_map(wanted=""):
    rooms, known = sources(), budget()
    chosen = [room for room in rooms if wanted in {"", room, room.split("/")[-1]}]
    if not chosen:
        sys.exit(f"no folder {wanted}; there are {' '.join(sorted({room.split('/')[-1] for room in rooms}))}")
    for room in chosen:
        print(f"{room}: {known.get(room, (0, ''))[1]}")
        if below := includes_from(room, rooms[room]):
            print(f"    includes from {' '.join(below)}")
        if wanted:
            modules = {path.with_suffix(""): path for path in reversed(rooms[room])}  # of beam.c and beam.h the first
            for path in reversed(modules.values()):
                print(f"    {path.name:24} {purpose(path)}")


signal.signal(signal.SIGPIPE, signal.SIG_DFL)
{"map": print_map, "check": check, "write": write}[sys.argv[1]](*sys.argv[2:])
