#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""paper_tables.py FILE.json PAGE.md: puts the tables of tests/bench/run paper between the lines `<!-- tables -->` and
`<!-- end of tables -->` of the page."""

import json
import re
import sys
from pathlib import Path

HEADS = ["cores: way", "grid", "gas, s", "exchange, s", "particles, s", "total, s", "OpenMP over this: particles", "total",
         "exchange, %", "exchange, ns a particle and gas step", "most particles over mean"]
PARTS = ("gas", "exchange", "particles")


def spread(found):
    return f"{found['median']:.2f} ({found['min']:.2f}, {found['max']:.2f})"


def row(cores, way, found):
    seconds, over = found["seconds"], found["OpenMP_over_this"]
    return [f"{cores}: {way}", found["grid"], *(f"{seconds[part]['median']:.2f}" for part in PARTS),
            spread(seconds["total"]), spread(over["particles"]), spread(over["total"]),
            f"{found['exchange_percent']['median']:.1f}",
            f"{found['exchange_ns_a_particle_and_gas_step']['median']:.0f}", f"{found['most_particles_over_mean']:.2f}"]


def section(title, scene):
    lines = [f"### {title}", f"{scene['what']} The paper: {scene['paper']}", ""]
    rows = [row(cores, way, found) for cores, ways in scene["by_cores"].items() for way, found in ways.items()]
    lines += [f"| {' | '.join(cells)} |" for cells in (HEADS, ["---"] * len(HEADS), *rows)]
    return "\n".join(lines) + "\n"


def tables(result):
    head = (f"Revision {result['revision']}, {result['cpu']}, {result['cores']} cores; medians (least, most) of "
            f"{result['rounds']} rounds in turns{', --quick' * result['quick']}.\n")
    return "\n".join([head, *(section(title, scene) for title, scene in result["scenes"].items() if "by_cores" in scene)])


def main():
    result, page = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2])
    text = page.read_text()
    new, count = re.subn(r"(<!-- tables -->\n).*(<!-- end of tables -->)",
                         lambda found: found[1] + "\n" + tables(result) + "\n" + found[2], text, flags=re.S)
    if count != 1:
        sys.exit(f"{page} has no lines <!-- tables --> and <!-- end of tables -->")
    page.write_text(new)


if __name__ == "__main__":
    main()
