#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the references anew, with the packaged program liggghts. They change only on purpose: say why
in the commit that renews them.

Usage: renew_references.py [--liggghts PATH] [--mpirun 'COMMAND'] [--packings] [CASE...]
"""

import argparse
import gzip
import json
import pathlib
import platform
import shlex
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parent))  # granflux_regress

from granflux_regress.bed_statistics import (  # noqa: E402
    StatisticsOptions,
    compare_statistics,
    extent_of,
    floor_of,
    statistics_of,
)
from granflux_regress.compare import Comparison  # noqa: E402
from granflux_regress.dump import read_dump  # noqa: E402
from granflux_regress.tolerance import Tolerance  # noqa: E402

from case_table import read_cases  # noqa: E402
from container import container_of  # noqa: E402
from packing import packed_positions  # noqa: E402
from particles import DENSITY, radii_of  # noqa: E402
from run_case import REFERENCES, packing_name, run_case  # noqa: E402
from script import FIRST, HUNDRED, LATE, THOUSAND  # noqa: E402

MANIFEST = REFERENCES / "manifest.json"
LATE_COLUMNS = "id type x y z vx vy vz omegax omegay omegaz radius c_contacts".split()
THOUSAND_DIGITS = 12  # enough for a tolerance that is never below 1e-10
LATE_DIGITS = 6  # compared by statistics only
# Runs of the stock program that differ from the reference, one rank, by rounding only: other processor
# grids sum forces in another order, and positions may begin a last digit off. (Grids alone change nothing
# where spheres meet in twos. Another skin is no such run: new lists at other steps may change what a
# contact remembers by more than rounding.)
ROUNDING_RUNS = [
    *({"ranks": 2, "grid": grid} for grid in ("2 1 1", "1 2 1", "1 1 2")),
    *({"nudge": seed} for seed in (1, 2, 3)),
]


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--liggghts", default="liggghts", metavar="PATH")
    options.add_argument("--mpirun", default="mpirun --oversubscribe --allow-run-as-root --bind-to none")
    options.add_argument("--packings", action="store_true", help="also packs the dense beds anew")
    options.add_argument("cases", nargs="*", metavar="CASE", help="default: all")
    options = options.parse_args()
    cases = read_cases()
    unknown = set(options.cases) - {case.name for case in cases}
    if unknown:
        sys.exit(f"no case {', '.join(sorted(unknown))} in cases.txt")
    REFERENCES.mkdir(exist_ok=True)
    if options.packings:
        pack(cases)
    manifest = json.loads(MANIFEST.read_text()) if options.cases else {"spread": {}}
    for case in cases:
        if not options.cases or case.name in options.cases:
            spread = renew(case, options.liggghts, shlex.split(options.mpirun))
            manifest["spread"][case.name] = spread
            print(case.name, spread, flush=True)
    manifest.update(made_with(options))
    MANIFEST.write_text(json.dumps(manifest, indent=1) + "\n")


def pack(cases):
    for case in cases:
        if case.density == "dense" and case.container != "mesh":  # which shares that of planes
            positions = packed_positions(container_of(case), radii_of(case))
            text = "".join(" ".join(map(repr, point)) + "\n" for point in positions)
            write_compressed(REFERENCES / packing_name(case), text)


def renew(case, program, mpirun):
    """Writes the dumps of one case; returns how far stock runs lie apart that differ by rounding only:
    {step: {quantity or statistic: largest relative distance}}."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        reference = folder / "reference"
        reference.mkdir()
        run_case(case, program, mpirun, reference, LATE)
        store(case, reference)
        spread = {step: {} for step in (FIRST, HUNDRED, THOUSAND, LATE)}
        for number, how in enumerate(ROUNDING_RUNS):
            other = folder / str(number)
            other.mkdir()
            run_case(case, program, mpirun, other, LATE, **how)
            for step, largest in spread.items():
                snapshots = [next(read_dump(one / "atoms.dump", steps={step})) for one in (reference, other)]
                far = statistic_distances if step == LATE else distances
                for name, relative in far(case, *snapshots).items():
                    largest[name] = max(largest.get(name, 0.0), float(f"{relative:.3g}"))
    return spread


def distances(case, reference, other):
    """{quantity: largest distance of a particle, relative to the largest of the snapshot}."""
    comparison = Comparison(Tolerance(float("inf")))
    comparison.add(reference, other)
    if comparison.messages:
        raise RuntimeError(f"{case.name}: {comparison.messages}")
    return {d.quantity: d.relative for d in comparison.differences if d.quantity not in ("type", "radius")}


def statistic_distances(case, reference, other):
    options = StatisticsOptions(density=DENSITY)
    floor = floor_of(reference, options)
    both = [statistics_of(one, options, floor) for one in (reference, other)]
    found = compare_statistics(reference.step, *both, extent_of(reference), [])
    return {d.quantity: d.distance / d.scale for d in found if d.scale > 0}


def store(case, folder):
    atoms = dict(split(folder / "atoms.dump"))
    kept = [atoms[FIRST], atoms[HUNDRED], with_late_columns(atoms[THOUSAND], THOUSAND_DIGITS),
            with_late_columns(atoms[LATE], LATE_DIGITS)]
    for number, name in enumerate(("first", "hundred", "thousand", "late")):
        write_compressed(REFERENCES / f"{case.name}.{name}.dump.gz", kept[number])
    if case.history_size:
        contacts = dict(split(folder / "contacts.dump"))[HUNDRED]
        write_compressed(REFERENCES / f"{case.name}.contacts.dump.gz", contacts)


def split(path):
    """(step, text) of each snapshot of a dump."""
    head = "ITEM: TIMESTEP\n"
    return [(int(text.split("\n", 1)[0]), head + text) for text in path.read_text().split(head)[1:]]


def with_late_columns(text, digits):
    """The snapshot without the columns that are not compared so late, and with fewer digits."""
    head, title, rows = text.partition("ITEM: ATOMS ")
    names, *rows = rows.splitlines()
    kept = [names.split().index(name) for name in LATE_COLUMNS]

    rows = [" ".join(f"{float(row.split()[k]):.{digits}g}" for k in kept) for row in rows]
    return "\n".join([head + title + " ".join(LATE_COLUMNS), *rows]) + "\n"


def write_compressed(path, text):
    """As gzip -n -9 does: the same text gives the same bytes."""
    path.write_bytes(gzip.compress(text.encode(), 9, mtime=0))


def made_with(options):
    def first_line(command):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return (done.stdout or done.stderr).strip().splitlines()[0]

    return {
        "command": "tests/regression/reference_runs/renew_references.py",
        "reference": "liggghts on 1 rank",
        "rounding_runs": ROUNDING_RUNS,
        "liggghts": first_line([*shlex.split(options.mpirun), "-n", "1", options.liggghts, "-help"]),
        "liggghts_package": first_line(["dpkg-query", "-W", "liggghts"]),
        "mpirun": first_line(["mpirun", "--version"]),
        "machine": platform.machine(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


if __name__ == "__main__":
    main()
