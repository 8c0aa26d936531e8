#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs LIGGGHTS' own tutorials with liggghts and with granflux, and compares their last dumps.

The scripts are those of the package liggghts-doc. Two things are changed, by rule: the number of steps of
every `run` command is multiplied by a fraction (rounded up), and a `write_dump` is put behind the last
line. Dumps must be equal to 1e-10, or, where particles have collided long enough to lose their memory,
agree in the statistics of granflux-regress as runs of liggghts do whose time step is some last digits off.

Usage: tutorials.py [--table FILE.md] [--layouts 1x1,2x1] [NAME...]
Environment: GRANFLUX, LIGGGHTS and MPIRUN name the programs (default: from PATH). Exit code 0 if all agree.
"""

import argparse
import math
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass

from granflux_regress.bed_statistics import StatisticsOptions, compare_statistics, extent_of, floor_of, statistics_of
from granflux_regress.compare import Comparison
from granflux_regress.dump import read_dump
from granflux_regress.tolerance import Tolerance

PACKAGED = pathlib.Path("/usr/share/doc/liggghts/examples/LIGGGHTS/Tutorials_public")
COLUMNS = "id type x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz radius mass".split()
EXACT = Tolerance(1e-10)
# Runs of liggghts that differ from its own by rounding only: last digits that the time step is off.
NUDGES = (1, -1, 2)
CHANCE = 3.0  # the furthest of three such runs is near by chance at times
TIMEOUT = 900  # s, a run


@dataclass(frozen=True)
class Tutorial:
    name: str
    script: str
    fraction: float  # of the steps
    more_columns: tuple = ()
    setup_every: int = 0  # steps; 0: as the script has it


TUTORIALS = [
    Tutorial("contactModels", "in.newModels", 0.3),
    # Its spheres outgrow the cells of liggghts' lists, which fit the largest at the last setup: touching pairs are lost.
    Tutorial("packing", "in.packing", 1.0, setup_every=500),
    Tutorial("chute_wear", "in.chute_wear", 0.3),
    Tutorial("movingMeshGran", "in.movingMeshGran", 0.3),
    Tutorial("insert_stream", "in.insert_stream", 0.4),
    Tutorial("insert_stream", "in.insert_stream_reset_timestep", 0.1),  # goes on from the one before
    Tutorial("cohesion", "in.cohesion", 0.6),
    Tutorial("cohesion", "in.noCohesion", 0.6),
    Tutorial("conveyor", "in.conveyor", 0.6),
    Tutorial("heatTransfer_1", "in.heatGran", 0.4, ("f_Temp[0]",)),
    Tutorial("heatTransfer_2", "in.heatGran", 0.4, ("f_Temp[0]",)),
]


@dataclass(frozen=True)
class Way:
    """Which program runs a tutorial, and how."""

    program: str
    ranks: str
    threads: str = "1"
    nudge: int = 0


@dataclass
class Outcome:
    tutorial: Tutorial
    layout: str
    steps: int = 0
    particles: int = 0
    exact: str = ""  # largest distance of a particle, relative to the largest of the snapshot
    worst_statistic: str = ""  # in units of what is allowed
    contacts: str = ""  # by particle subset, or why not
    verdict: str = "differs"

    @property
    def agrees(self):
        return self.verdict.startswith("agree") or self.verdict == "equal"


def nudged(text, digits):
    """The script with a time step some last digits off."""

    def change(match):
        step = float(match[2])
        for _ in range(abs(digits)):
            step = math.nextafter(step, math.copysign(math.inf, digits))
        return f"{match[1]}{step!r}"

    text, found = re.subn(r"(?m)^(\s*timestep\s+)([\d.eE+-]+)", change, text)
    if found != 1:
        raise RuntimeError(f"{found} time steps in the script")
    return text


def shortened(text, tutorial):
    """The script with fewer steps, and a dump at its end."""
    values = dict(re.findall(r"(?m)^\s*variable\s+(\w+)\s+equal\s+(\d+)\s*$", text))

    def fewer(match):
        count = re.sub(r"\$\{(\w+)\}", lambda name: values[name[1]], match[2])
        steps = math.ceil(int(count) * tutorial.fraction)
        again = f" every {tutorial.setup_every} NULL" if 0 < tutorial.setup_every < steps else ""
        return f"{match[1]}{steps}{again}"

    text = re.sub(r"(?m)^(\s*run\s+)(\S+)", fewer, text)
    columns = [*COLUMNS, *tutorial.more_columns]
    form = " ".join(["%d %d"] + ["%.17g"] * (len(columns) - 2))
    return f'{text}\nwrite_dump all custom end.dump {" ".join(columns)} modify sort id format "{form}"\n'


def run(way, tutorial, folder):
    """Leaves the dump in the tutorial's folder below `folder`; returns it and what the program says."""
    where = folder / tutorial.name
    if not where.exists():  # a second script of a tutorial starts where the first one ended
        shutil.copytree(PACKAGED / tutorial.name, where)
        (where / "post").mkdir(exist_ok=True)
    text = (PACKAGED / tutorial.name / tutorial.script).read_text()
    (where / tutorial.script).write_text(shortened(nudged(text, way.nudge), tutorial))
    command = [*shlex.split(os.environ.get("MPIRUN", "mpirun")), "-n", way.ranks, way.program, "-in", tutorial.script, "-log", "none"]
    done = subprocess.run(command, cwd=where, env={**os.environ, "OMP_NUM_THREADS": way.threads}, timeout=TIMEOUT,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", check=False)
    if done.returncode != 0 or "ERROR" in done.stdout:
        reason = [line for line in done.stdout.splitlines() if "ERROR" in line] or [f"exit code {done.returncode}"]
        raise RuntimeError(f"{os.path.basename(way.program)}: {reason[0]}")
    for file in (where / "post").glob("*.vt*"):
        file.unlink()
    return next(read_dump(where / "end.dump")), done.stdout


def way_of_contacts(output):
    """As granflux says at the beginning of its first run."""
    said = re.search(r"granflux: contact forces (by particle subset|are LIGGGHTS' own: (.*) has no form)", output)
    return "not said" if said is None else "subset" if said[2] is None else f"LIGGGHTS' own: {said[2]}"


def statistics_of_two(reference, other):
    options = StatisticsOptions()
    floor = floor_of(reference, options)
    return compare_statistics(reference.step, statistics_of(reference, options, floor),
                              statistics_of(other, options, floor), extent_of(reference), [])


def allow_chance(statistics, reference, nudges):
    """Allows what CHANCE times the furthest of the nudged runs shows."""
    for nudge in nudges:
        for found, by_chance in zip(statistics, statistics_of_two(reference, nudge), strict=True):
            found.allowed = max(found.allowed, CHANCE * by_chance.distance)


def compare(outcome, reference, nudges, other):
    outcome.steps, outcome.particles = reference.step, len(reference.values)
    statistics = statistics_of_two(reference, other)
    allow_chance(statistics, reference, nudges)
    worst = max((d for d in statistics if d.allowed > 0), key=lambda d: d.distance / d.allowed)
    outcome.worst_statistic = f"{worst.distance / worst.allowed:.2g} ({worst.quantity})" if worst.distance else "0"
    comparison = Comparison(EXACT)
    comparison.add(reference, other)
    furthest = max(comparison.differences, key=lambda d: d.relative)
    outcome.exact = f"{furthest.relative:.1e} ({furthest.quantity})" if furthest.relative else "0"
    if comparison.equal:
        outcome.verdict = "equal"
    elif not any(d.failed for d in statistics):
        outcome.verdict = "agree in statistics"


class Runs:
    """Each way to run a tutorial, once, all in the order of the tutorials."""

    def __init__(self, folder):
        self.folder = folder
        self.done = {}

    def get(self, way, tutorial):
        if (way, tutorial) not in self.done:
            folder = self.folder / "-".join(map(str, (os.path.basename(way.program), way.ranks, way.threads, way.nudge)))
            self.done[way, tutorial] = run(way, tutorial, folder)
        return self.done[way, tutorial]


def judged(tutorial, layout, runs, liggghts, granflux):
    outcome = Outcome(tutorial, layout)
    ranks, threads = layout.split("x")
    try:
        reference, _ = runs.get(Way(liggghts, ranks), tutorial)
        nudges = [runs.get(Way(liggghts, ranks, nudge=digits), tutorial)[0] for digits in NUDGES]
        other, output = runs.get(Way(granflux, ranks, threads), tutorial)
        outcome.contacts = way_of_contacts(output)
        compare(outcome, reference, nudges, other)
    except (RuntimeError, subprocess.TimeoutExpired) as problem:
        outcome.verdict = f"failed: {problem}"
    return outcome


HEAD = """# LIGGGHTS' own tutorials, with liggghts and with granflux

Scripts of the package liggghts-doc, shortened by rule: the steps of every `run` command times the
fraction given, rounded up; nothing else is changed but for a `write_dump` behind the last line. Compared
is the state after the last step. Made again by

    ctest --test-dir build/release -R regression.tutorials     # writes build/release/tutorials.md

* *distance*: of the particle furthest from the stock run, relative to the largest value of the snapshot
  (0: every digit is the same); equal means at most 1e-10.
* *statistic*: the one nearest to what is allowed, in units of it; it counts where the distance is more than 1e-10. Allowed are the
  [tolerances](../reference/granflux_regress.md), or three times what the furthest of three runs of liggghts shows whose time step
  is 1 or 2 last digits off: beds at rest have hardly any kinetic energy, and what there is belongs to the rounding.
* *layout*: ranks x threads of granflux; liggghts has the same ranks.
* *contacts*: computed by particle subset, or by LIGGGHTS' own loop for the reason given.

| tutorial | fraction | last step | particles | layout | contacts | distance | statistic | verdict |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
"""
TAIL = """
Both programs run `packing` with a setup every 500 steps (`run N every 500 NULL`). Its spheres grow to 1.4 times their
size in one run, and liggghts 3.8.0 finds pairs in cells that fit the largest sphere of the last setup: it loses
touching ones (at step 24244 of the script as it is, the pair 99, 115 with a force of 0.07 N), and the packing comes out
another. GranFlux sizes its cells anew at every build.

`contactModels/in.oldModels` is not in the table: liggghts 3.8.0 itself refuses it (Invalid pair style
`gran/hertz/history`). The insertion of particles draws random numbers by rank, so runs of different
numbers of ranks are different beds, and are not compared.

`in.insert_stream_reset_timestep` reads a restart file with particles that wait for their release. On 2 ranks liggghts 3.8.0 gives them
velocities from memory that nobody has set: two runs of liggghts itself from one file differ from the step of the first
release on (particle 301 with (0, -0.5, -2) m/s, as the script has it, in one, 1e-323 m/s in the other), and so do
two of granflux, with particle subsets or without. By chance all get the same, and then the two programs are equal.
"""


def table(outcomes, state):
    rows = [
        f"| {o.tutorial.name}/{o.tutorial.script} | {o.tutorial.fraction:g} | {o.steps} | {o.particles} | {o.layout} | {o.contacts} | "
        f"{o.exact} | {o.worst_statistic} | {o.verdict} |\n"
        for o in outcomes
    ]
    return HEAD + "".join(rows) + TAIL + f"\n{state}\n"


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--table", type=pathlib.Path, metavar="FILE.md")
    options.add_argument("--layouts", default="1x1,1x2,2x1", metavar="RANKSxTHREADS,...")
    options.add_argument("names", nargs="*", metavar="NAME")
    options = options.parse_args()
    unknown = set(options.names) - {tutorial.name for tutorial in TUTORIALS}
    if unknown:
        sys.exit(f"no tutorial {', '.join(sorted(unknown))}; there are {', '.join(t.name for t in TUTORIALS)}")
    chosen = [t for t in TUTORIALS if not options.names or t.name in options.names]
    programs = [os.environ.get("LIGGGHTS", "liggghts"), os.environ.get("GRANFLUX", "granflux")]
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(pathlib.Path(folder))
        for layout in options.layouts.split(","):
            for tutorial in chosen:
                outcomes.append(judged(tutorial, layout, runs, *programs))
                print(outcomes[-1], flush=True)
    version = subprocess.run([programs[1], "-version"], capture_output=True, text=True, check=True).stdout
    state = "State: " + ", ".join(line for line in version.splitlines() if line.startswith(("granflux", "host")))
    if options.table:
        options.table.write_text(table(outcomes, state))
    return 0 if all(outcome.agrees for outcome in outcomes) else 1


if __name__ == "__main__":
    sys.exit(main())
