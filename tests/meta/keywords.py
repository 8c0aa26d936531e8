# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of keywords in docs/reference have the words that the programs know, no more and no fewer.

Usage: keywords.py ROOT
"""

import re
import sys
from pathlib import Path

from source_tree import report

DRIVER = "liggghts_plugin/driver"
# What a reader of a case file asks a table for.
ASKED = re.compile(r"\b(?:number|integer|flag|text|word|choice|vector|has|refuse|fail)s?(?:<[\w:]+>)?\(\s*\"(\w+)\"")


def list_of_keywords(text):
    found = re.search(r"keywords\{(.*?)\};", text, re.DOTALL)
    return set(re.findall(r'"(\w+)"', found.group(1))) if found else set()


def options_taken(text):
    return set(re.findall(r'take_option\(argc, argv, "(-\w+)"', text))


def case_keys(text):
    keys = set(ASKED.findall(text)) - {"energy"}  # the table itself
    # nodes_x, nodes_y, nodes_z are asked for in turn
    return keys | ({"nodes_x", "nodes_y", "nodes_z"} if '"nodes_x"' in text or '"nodes_"' in text else set())


def table_words(text, head):
    """Names in the first column of the tables whose first heading is `head`."""
    found, inside = set(), False
    for line in text.splitlines():
        cells = line.split("|")
        if len(cells) < 3:
            inside = False
        elif cells[1].strip().strip("`") == "kind" and head == "key":
            found.add("kind")
        elif cells[1].strip() == head:
            inside = True
        elif inside:
            found |= set(re.findall(r"`(-?\w+)`", cells[1]))
    return found


# Page, first heading of its tables, sources, what they know.
TABLES = [
    ("fix_granflux_couple.md", "keyword", [f"{DRIVER}/couple_options.cpp"], list_of_keywords),
    ("fix_granflux_heat.md", "keyword", [f"{DRIVER}/heat_options.cpp"], list_of_keywords),
    ("granflux.md", "option", [f"{DRIVER}/command_line.cpp", "liggghts_plugin/liggghts/launch_options.cpp"],
     options_taken),
    ("case_file.md", "key", ["cfd_lib/src/read_gas_case.cpp", "cfd_lib/src/read_grid.cpp",
                             "coupling/src/read_coupling.cpp"], case_keys),
]


def faults_of(root, tables=None):
    faults = []
    for page, head, sources, known_by in tables or TABLES:
        known = known_by("\n".join((root / source).read_text() for source in sources))
        told = table_words((root / "docs/reference" / page).read_text(), head)
        faults += [f"docs/reference/{page}: {word} is not in its tables" for word in sorted(known - told)]
        faults += [f"docs/reference/{page}: {word} is unknown to {sources[0]}" for word in sorted(told - known)]
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]))))
