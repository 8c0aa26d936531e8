# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The gas alone in a lid-driven cavity: granflux_cfd beside the packaged icoFoam, in turns.

Seconds of a step are those of a long run less those of a short one, so start-up drops out; of the
clock, and of the processors (user and system, summed over ranks and threads), which a busy machine
disturbs less. The divergence of both programs is measured as icoFoam prints it, time step times
the mean of |div u| over the cells; granflux_cfd prints the largest relative to the fluxes, from
which follows time step times the largest |div u|, never less than that mean.
"""

import os
import re
import shutil
import statistics
import string
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from measure import ENVIRONMENT, ROOT, measured_start, spread

GRANFLUX_CFD = ROOT / "build/release/bin/granflux_cfd"
TRIAD = ROOT / "build/release/bin/bench_triad"
CAVITY = ROOT / "tests/bench/cavity"
# Ranks and threads wait for each other as they do where nothing is said: by spinning, which a core
# of their own allows; the ranks of a loaded machine would wait for the scheduler otherwise.
QUIET = {name: value for name, value in ENVIRONMENT.items() if name != "OMP_WAIT_POLICY"}
FOAM = dict(QUIET, WM_PROJECT_DIR=os.environ.get("WM_PROJECT_DIR", "/usr/share/openfoam"))
GAMG = "preconditioner {{ preconditioner GAMG; smoother {}; tolerance 1e-6; relTol 0; }}"
PRESSURE_SOLVERS = {
    **{f"GAMG, {smoother}": f"solver GAMG; smoother {smoother};"
       for smoother in ("GaussSeidel", "symGaussSeidel", "DIC", "DICGaussSeidel")},
    "GAMG, GaussSeidel, one sweep": "solver GAMG; smoother GaussSeidel; nPostSweeps 1; "
                                    "nFinestSweeps 1;",
    "PCG, GAMG, GaussSeidel": "solver PCG; " + GAMG.format("GaussSeidel"),
    "PCG, GAMG, DIC": "solver PCG; " + GAMG.format("DIC"),
    "PCG, DIC": "solver PCG; preconditioner DIC;",
}
VISCOUS_TOLERANCE = 1e-6  # of both programs
DEFAULT_TOLERANCE = 1e-10  # of a case file that gives none
# Function of the program, by the first of these names in its symbol, and its part of a step.
PARTS = {
    "pressure solver": r"Multigrid|PressureSolver|_plane|step_row<\w+, false|coarse|Coarse|"
                       r"scale_to_one|smooth_|spread",
    "viscous solver": r"DiffusionSolver|cfd::diffusion\(|step_row<\w+, true",
    "convection": r"convect<|convect_momentum|Central|through",
    "rest of the predictor": r"predict|begin_momentum|add_new_friction|viscous_force|"
                             r"set_conductance|set_momentum|set_medium|GasSolver::advance|"
                             r"move_void_fraction",
    "projection": r"interpolate_momentum|project|set_pressure_gradient|set_gradient|set_velocity|"
                  r"take_continuity",
    "boundaries and halo": r"Boundaries|Halo|Level::exchange",
    "balance and report": r"measure|momentum\(\)|take_balance|check_finite",
    "system": r"\[k\]",
}


def time_step(cells):
    return 0.32 / cells  # s: Courant number of the lid


class Foam:
    """icoFoam on so many ranks, its mesh made."""

    def __init__(self, folder, cells, ranks):
        self.folder, self.cells, self.ranks = folder, cells, ranks
        shutil.copytree(CAVITY, folder)
        self.set_run(1, PRESSURE_SOLVERS["GAMG, GaussSeidel"])
        self.start("blockMesh")
        if ranks > 1:
            self.start("decomposePar")

    def start(self, program, *words, ranks=1):
        return measured_start(self.folder, program, *words, ranks=ranks, environment=FOAM)

    def set_run(self, steps, solver):
        step = time_step(self.cells)
        (self.folder / "system/parameters").write_text(
            f"cells {self.cells};\ndeltaT {step};\nendTime {steps * step};\n"
            f"pressureSolver {{ {solver} }}\n")

    def run(self, steps, solver):
        self.set_run(steps, solver)
        return self.start("icoFoam", *(["-parallel"] if self.ranks > 1 else []), ranks=self.ranks)

    def best_solver(self, steps, among):
        """The fastest, by the program's own count of processor time; and that of each, ns."""
        found = {}
        for name in among:
            seconds = [float(s) for s in re.findall(r"ExecutionTime = ([\d.]+) s",
                                                    self.run(steps, PRESSURE_SOLVERS[name]).output)]
            found[name] = (1e9 * (seconds[-1] - seconds[0]) * self.ranks /
                           ((steps - 1) * self.cells**3))
        best = min(found, key=found.get)
        return best, found


def foam_divergence(output):
    """At the end of each step."""
    return [float(re.findall(r"sum local = ([\d.eE+-]+)", step)[-1])
            for step in output.split("\nTime = ")[1:]]


def foam_iterations(output, first):
    last_steps = output.split("\nTime = ")[1 + first:]
    return [statistics.median(numbers) for numbers in zip(*(
        [int(n) for n in re.findall(r"Solving for p,.*No Iterations (\d+)", step)]
        for step in last_steps))]


class Cavity:
    """granflux_cfd on so many threads and ranks."""

    def __init__(self, folder, cells, tolerance, threads=1, ranks=1, viscous=VISCOUS_TOLERANCE):
        folder.mkdir(exist_ok=True)
        self.folder, self.cells, self.tolerance, self.viscous = folder, cells, tolerance, viscous
        self.threads, self.ranks = threads, ranks

    def run(self, steps, wrapper=()):
        step = time_step(self.cells)
        case = string.Template((CAVITY / "cavity.toml").read_text()).substitute(
            cells=self.cells, time_step=step, end_time=steps * step,
            pressure_tolerance=self.tolerance, viscous_tolerance=self.viscous)
        (self.folder / "cavity.toml").write_text(case)
        return measured_start(self.folder, GRANFLUX_CFD, "cavity.toml",
                              "--threads", str(self.threads), ranks=self.ranks,
                              environment=QUIET, wrapper=wrapper)


def step_table(output):
    """{step: (Courant number, continuity, pressure iterations, viscous iterations)}"""
    rows = re.findall(r"^ +(\d+) +\S+ +[\d.]+% +(\S+) +(\S+) +(\d+) +(\d+)", output, re.M)
    return {int(step): (float(c), float(r), int(p), int(v)) for step, c, r, p, v in rows}


def divergence(output, first):
    """Largest after the step `first`; the Courant number is half the gross fluxes over a step."""
    return max(2 * courant * continuity
               for step, (courant, continuity, *_) in step_table(output).items() if step > first)


def iterations(output, first):
    rows = [row for step, row in step_table(output).items() if step > first]
    return {"pressure": statistics.median(row[2] for row in rows),
            "viscous": statistics.median(row[3] for row in rows)}


def loosest_tolerance(folder, cells, steps, first, wanted):
    for exponent in range(-4, -15, -1):
        tolerance = 10.0**exponent
        if divergence(Cavity(folder, cells, tolerance).run(steps).output, first) <= wanted:
            return tolerance
    sys.exit(f"granflux_cfd reaches a divergence of {wanted} at no tolerance")


class Series:
    """Rounds of one program: a short and a long run each."""

    def __init__(self, run, cells, steps):
        self.run, self.cells, self.steps = run, cells, steps
        self.wall, self.cpu, self.output = [], [], ""

    def round(self):
        short, long = (self.run(steps) for steps in self.steps)
        per_cell = 1e9 / ((self.steps[1] - self.steps[0]) * self.cells**3)
        self.wall.append(per_cell * (long.wall - short.wall))
        self.cpu.append(per_cell * (long.cpu - short.cpu))
        self.output = long.output

    def result(self):
        return {"cpu_ns_per_cell_step": spread(self.cpu),
                "wall_ns_per_cell_step": spread(self.wall)}


def bandwidth(threads):
    """GB/s"""
    environment = dict(QUIET, OMP_NUM_THREADS=str(threads))
    return float(measured_start(ROOT, TRIAD, environment=environment).output)


def part_of(symbol):
    found = {part: match.start() for part, pattern in PARTS.items()
             if (match := re.search(pattern, symbol))}
    return min(found, key=found.get) if found else "other"


def samples(case, steps):
    """Of perf, by symbol."""
    data = case.folder / "perf.data"
    case.run(steps, wrapper=("perf", "record", "-q", "-e", "cpu-clock", "-F", "997",
                             "-o", str(data)))
    report = subprocess.run(["perf", "report", "-i", str(data), "--stdio", "--sort", "symbol", "-n",
                             "-g", "none", "-w", "0"], text=True, capture_output=True).stdout
    rows = re.findall(r"^ +[\d.]+% +(\d+) +(\[.\] .*?)(?: +- +-)? *$", report, re.M)
    return Counter({symbol: int(count) for count, symbol in rows})


def readable(symbol):
    """A symbol without namespaces and arguments, as far as one can read it."""
    symbol = re.sub(r"^\[.\] |granflux::cfd::|\(anonymous namespace\)::|Impl::", "", symbol)
    return symbol.partition("(")[0][:90]


def profile(case, steps):
    """Shares of a step in percent, start-up taken off; None where perf does not work."""
    if not shutil.which("perf"):
        return None
    short, long = (samples(case, count) for count in steps)
    long.subtract(short)
    total = sum(long.values())
    if total <= 0:
        return None
    parts, functions = Counter(), Counter()
    for symbol, count in long.items():
        parts[part_of(symbol)] += count
        functions[readable(symbol)] += count
    return {"samples": total,
            "percent_by_part": {name: 100 * n / total for name, n in parts.most_common()},
            "percent_by_function": {name: 100 * n / total for name, n in functions.most_common(25)}}


def ratio(theirs, ours):
    return {"cpu": spread([a / b for a, b in zip(theirs.cpu, ours.cpu)]),
            "wall": spread([a / b for a, b in zip(theirs.wall, ours.wall)])}


def require_programs():
    for program, package in (("icoFoam", "openfoam"), ("blockMesh", "openfoam"),
                             ("decomposePar", "openfoam"), ("mpirun", "openmpi-bin")):
        if not shutil.which(program):
            sys.exit(f"{program} is not there: install Debian's package {package}")
    for program in (GRANFLUX_CFD, TRIAD):
        if not program.exists():
            sys.exit(f"{program} is not there: build first (./test or ./run does)")


def cfd(quick):
    require_programs()
    cells, rounds = 64, 3 if quick else 5
    steps = (3, 13) if quick else (5, 25)  # of the short and the long runs
    sizes = {32: (5, 85) if quick else (5, 165), 64: steps, 128: (2, 6) if quick else (3, 11)}
    loads = [os.getloadavg()[0]]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        foams = {ranks: Foam(folder / f"foam{ranks}", cells, ranks) for ranks in (1, 2)}
        best, found, among = {}, {}, list(PRESSURE_SOLVERS)
        for ranks, foam in foams.items():
            best[ranks], found[ranks] = foam.best_solver(4, among)
            print(f"icoFoam on {ranks}: {best[ranks]}", file=sys.stderr)
            among = sorted(among, key=found[ranks].get)[:3]
        wanted = max(foam_divergence(
            foams[1].run(steps[1], PRESSURE_SOLVERS[best[1]]).output)[steps[0]:])
        tolerance = loosest_tolerance(folder / "tolerance", cells, steps[1], steps[0], wanted)
        print(f"divergence of icoFoam {wanted:.2g}: pressure_tolerance {tolerance:g}",
              file=sys.stderr)

        def foam_series(ranks):
            solver = PRESSURE_SOLVERS[best[ranks]]
            return Series(lambda n: foams[ranks].run(n, solver), cells, steps)

        def series(name, n, **options):
            case = Cavity(folder / name.replace(" ", "_"), n,
                          **{"tolerance": tolerance, **options})
            return Series(case.run, n, sizes[n])

        runs = {"icoFoam 1 rank": foam_series(1),
                "granflux_cfd 1 thread": series("one", cells),
                "icoFoam 2 ranks": foam_series(2),
                "granflux_cfd 2 threads": series("threads", cells, threads=2),
                "granflux_cfd 2 ranks": series("ranks", cells, ranks=2),
                "granflux_cfd 1 thread, default tolerances":
                    series("tight", cells, tolerance=DEFAULT_TOLERANCE, viscous=DEFAULT_TOLERANCE)}
        growth = {n: runs["granflux_cfd 1 thread"] if n == cells else series(f"size {n}", n)
                  for n in sizes}
        triads = {threads: [] for threads in (1, 2)}
        for i in range(rounds):
            for run in dict.fromkeys([*runs.values(), *growth.values()]):
                run.round()
            for threads, rates in triads.items():
                rates.append(bandwidth(threads))
            loads.append(os.getloadavg()[0])
            print(f"round {i + 1}/{rounds}, load {loads[-1]:.1f}, processor time, ns per cell and "
                  "step: " + ", ".join(f"{name} {run.cpu[-1]:.0f}" for name, run in runs.items()) +
                  "; " + ", ".join(f"{n}^3 {run.cpu[-1]:.0f}" for n, run in growth.items()),
                  file=sys.stderr)
        profiles = {f"{n}^3": profile(Cavity(folder / f"profile{n}", n, tolerance), sizes[n])
                    for n in sizes}
    first = steps[0]
    return {
        "case": f"lid-driven cavity, Re 1000, {cells}^3 cells, time step {time_step(cells):g} L/U, "
                f"steps {first + 1} to {steps[1]} after the start from rest",
        "rounds": rounds,
        "load_average": spread(loads),
        "best_pressure_solver_of_icoFoam": {f"{ranks} ranks": name for ranks, name in best.items()},
        "processor_ns_per_cell_step_by_solver_of_icoFoam": {f"{ranks} ranks": f
                                                            for ranks, f in found.items()},
        "pressure_tolerance": tolerance, "viscous_tolerance": VISCOUS_TOLERANCE,
        "divergence": {
            "norm": "time step times |div u|, largest of the steps; icoFoam: mean over cells, "
                    "granflux_cfd: largest of the cells, which bounds the mean",
            **{name: divergence(run.output, first) if name.startswith("granflux_cfd")
               else max(foam_divergence(run.output)[first:]) for name, run in runs.items()}},
        "iterations": {
            **{name: iterations(run.output, first) if name.startswith("granflux_cfd")
               else {"pressure": foam_iterations(run.output, first)}
               for name, run in runs.items()},
            **{f"granflux_cfd {n}^3": iterations(run.output, sizes[n][0])
               for n, run in growth.items()}},
        "runs": {name: run.result() for name, run in runs.items()},
        "times_faster": {
            f"{ours} than {theirs}": ratio(runs[theirs], runs[ours]) for ours, theirs in (
                ("granflux_cfd 1 thread", "icoFoam 1 rank"),
                ("granflux_cfd 1 thread, default tolerances", "icoFoam 1 rank"),
                ("granflux_cfd 2 threads", "icoFoam 2 ranks"),
                ("granflux_cfd 2 ranks", "icoFoam 2 ranks"))},
        "by_size": {f"{n}^3": {"steps": sizes[n], **run.result()} for n, run in growth.items()},
        "growth_from_32_to_128": spread([b / a for a, b in zip(growth[32].cpu, growth[128].cpu)]),
        "triad_gigabytes_per_second": {f"{threads} threads": spread(rates)
                                       for threads, rates in triads.items()},
        "profile": profiles,
    }
