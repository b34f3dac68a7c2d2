#!/usr/bin/env python3
# rooms.py - prints the map of kernel and host: `make map`. SPDX-License-Identifier: MIT
"""rooms.py map [ROOM]: folders, what for, the folders they include from; of a ROOM (heat, kernel/heat) its files, too.

What a folder is for stands in tests/budget.txt, what a file is for in its first line."""

import pathlib
import re
import sys

SOURCES = {".c", ".h", ".cpp", ".py", ".f90"}
BUDGET = pathlib.Path("tests/budget.txt")


def sources():
    """The sources of kernel and host by folder; the folder lanes belongs to its parent."""
    rooms = {}
    for tree in ("kernel", "host"):
        for path in sorted(pathlib.Path(tree).rglob("*.*")):
            if path.suffix in SOURCES:
                rooms.setdefault(str(path.parent).removesuffix("/lanes"), []).append(path)
    return rooms


def budget():
    """{room: (lines, what for)} as tests/budget.txt has it."""
    rows = (line.split(None, 2) for line in BUDGET.read_text().splitlines() if line and line[0] != "#")
    return {row[0]: (int(row[1]), row[2] if len(row) > 2 else "") for row in rows}


def includes_from(room, files):
    """The folders of the same tree that the files of a room include from."""
    tree, _, name = room.partition("/")
    found = re.findall(r'^#include "([a-z_/]*)/', "\n".join(path.read_text() for path in files), re.M)
    return sorted({folder.removesuffix("/lanes") for folder in found} - {name, tree})


def purpose(path):
    """What the first line of a file says after its name."""
    line = path.read_text().split("\n", 2)
    line = line[1] if line[0].startswith("#!") or "clang-format" in line[0] else line[0]
    text = line.partition(" - ")[2].replace("SPDX-License-Identifier: MIT", "").strip(" */")
    return text.partition(". ")[0].rstrip(".")


def print_map(wanted):
    rooms, known = sources(), budget()
    chosen = [room for room in rooms if not wanted or room == wanted or room.split("/")[-1] == wanted]
    if not chosen:
        sys.exit(f"no room {wanted}; rooms: {' '.join(sorted({room.split('/')[-1] for room in rooms}))}")
    for room in chosen:
        print(f"{room}: {known.get(room, (0, ''))[1]}")
        below = includes_from(room, rooms[room])
        if below:
            print(f"    includes from {' '.join(below)}")
        if wanted:
            modules = {path.with_suffix(""): path for path in reversed(rooms[room])} # of beam.c and beam.h the first
            for path in reversed(modules.values()):
                print(f"    {path.name:24} {purpose(path)}")


print_map(sys.argv[2] if len(sys.argv) > 2 else "")
