# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The tables and figures on performance of Amritkar, Deb, Tafti, J. Comput. Phys. 256 (2014), with gas: the
small bed (Table 2), the large bed (Fig. 4), the kiln (Table 5, Fig. 11), by threads, by ranks and by both."""

import os
import re
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from measure import GRANFLUX, ROOT, measured_start, spread
from scaling import in_plane, seconds_a_step

CORES = os.cpu_count()
AUTOMATIC = ("*", "*", "*")
class Way(NamedTuple):
    """How a scene is divided."""
    name: str
    ranks: int
    threads: int
    subset: bool  # particle work by GranFlux, else LIGGGHTS' own loops
    grid: str  # "automatic" or "best"


def ways_on(cores):
    if cores == 1:
        return [Way("MPI, LIGGGHTS' loops", 1, 1, False, "best"), Way("OpenMP", 1, 1, True, "best")]
    found = [Way("OpenMP", 1, cores, True, "best"),
             Way("MPI, LIGGGHTS' loops, automatic grid", cores, 1, False, "automatic"),
             Way("MPI, LIGGGHTS' loops, best grid", cores, 1, False, "best"),
             Way("MPI, particle subset, best grid", cores, 1, True, "best")]
    if cores % 2 == 0 and cores > 2:
        found.append(Way(f"hybrid, 2 ranks x {cores // 2} threads", 2, cores // 2, True, "best"))
    return found


def grids_of(ranks):
    return [(x, y, ranks // x // y) for x in range(1, ranks + 1) if ranks % x == 0
            for y in range(1, ranks // x + 1) if ranks // x % y == 0]


class CoupledScene:
    """An example's scripts in a folder, and their variables: `prepare` makes the state that `timed` runs start
    from, on the same number of ranks; `fresh` runs start without one."""

    def __init__(self, folder, title, example, script, steps, prepare, timed, fresh, grid_names):
        self.folder, self.title, self.script, self.steps = folder, title, script, steps
        self._prepare, self._timed, self._fresh, self._grid_names = prepare, timed, fresh, grid_names
        folder.mkdir()
        for file in [*(ROOT / "examples" / example).iterdir(), *(ROOT / "tests/bench/paper").iterdir()]:
            if file.is_file():
                text = file.read_text()
                # Gas fields would be written where nobody looks.
                (folder / file.name).write_text(re.sub(r"\n\[output\].*", "\n", text, flags=re.S)
                                                if file.suffix == ".toml" else text)

    def grid_words(self, grid):
        return [word for name, value in zip(self._grid_names, grid) for word in ("-var", name, str(value))]

    def prepare(self, ranks):
        """A state is read by as many ranks as have written it."""
        print(f"{self.title}: mixing on {ranks} ranks ...", file=sys.stderr)
        self._prepare(self, ranks)

    def run(self, way, grid, steps, **options):
        words = ["-threads", str(way.threads), "-subset", "on" if way.subset else "off", "-in", self.script,
                 *self._timed(way.ranks, steps), *self.grid_words(grid)]
        return measured_start(self.folder, GRANFLUX, *words, ranks=way.ranks, **options)

    def words(self, _, grid, steps):  # as a scene of scaling.py: no state of other ranks is needed
        return ["-in", self.script, *self._fresh(steps), *self.grid_words(grid)]


def seconds_of_parts(output):
    """Of the last run with gas. What the quickest rank takes for gas and exchange is what they take: others wait
    there for the slowest rank's particles, whose time is what is left of the total."""
    table = output[output.rindex("granflux: time of the run"):]
    rows = {name: (float(mean), float(least)) for name, mean, least in re.findall(
        r"^  (\w[a-z ,]*?) {2,}(-?[\d.]+) +-?[\d.]+ +-?[\d.]+ +(-?[\d.]+) +-?[\d.]+$", table, re.M)}
    total, gas, exchange = rows["total"][0], rows["gas"][1], rows["exchange"][1]
    return {"total": total, "gas": gas, "exchange": exchange, "particles": total - gas - exchange}


def load_of(output):
    def found(name):
        return {key: float(value) for key, value in zip(
            ("mean", "most", "least"), re.findall(rf"{name}: +(\S+) ave (\S+) max (\S+) min", output)[-1])}
    particles, ghosts = found("Nlocal"), found("Nghost")
    return {"particles": int(re.findall(r"Loop time of .* with (\d+) atoms", output)[-1]),
            "most_particles_over_mean": particles["most"] / particles["mean"], "ghosts_a_rank": ghosts["mean"],
            "most_ghosts": ghosts["most"], "peak_memory": re.findall(r"granflux: peak memory (.*)", output)[-1]}


def best_grid(scene, ranks):
    if ranks == 1:
        return (1, 1, 1)
    seconds = {grid: seconds_of_parts(scene.run(Way("", ranks, 1, False, "best"), grid, max(scene.steps // 5, 10)).output)
               ["total"] for grid in grids_of(ranks)}
    return min(seconds, key=seconds.get)


def by_cores(scene, rounds):
    """{cores: {way: its times}}, ways taking turns."""
    result = {}
    for cores in [n for n in (1, 2, 4, 8, 16, 32) if n <= CORES]:
        ways = ways_on(cores)
        for ranks in {way.ranks for way in ways}:
            scene.prepare(ranks)
        best = {ranks: best_grid(scene, ranks) for ranks in {way.ranks for way in ways}}
        parts, loads = {way: [] for way in ways}, {}
        for i in range(rounds):
            for way in ways:
                output = scene.run(way, AUTOMATIC if way.grid == "automatic" else best[way.ranks], scene.steps).output
                parts[way].append(seconds_of_parts(output))
                loads[way] = load_of(output)
            print(f"{scene.title}, {cores} cores, round {i + 1}/{rounds}: " +
                  ", ".join(f"{way.name} {found[-1]['total']:.2f} s" for way, found in parts.items()), file=sys.stderr)

        def over(way, against, part):
            return spread([a[part] / b[part] for a, b in zip(parts[way], parts[against])])

        threads = next(way for way in ways if way.name == "OpenMP")
        result[cores] = {
            way.name: {"seconds": {part: spread([p[part] for p in found]) for part in found[0]},
                       "exchange_percent": spread([100 * p["exchange"] / p["total"] for p in found]),
                       "exchange_ns_a_particle_and_gas_step": spread(
                           [1e9 * p["exchange"] / loads[way]["particles"] / scene.steps for p in found]),
                       "OpenMP_over_this": {part: over(threads, way, part) for part in ("total", "particles")},
                       "grid": way.grid if way.grid == "automatic" else " ".join(map(str, best[way.ranks])),
                       **loads[way]}
            for way, found in parts.items()}
    return result


def derived(scene, counts, steps):
    """{count: {way: seconds of processor a step of the slowest rank or thread}}, on cores that take turns: what as
    many cores would take at best."""
    table = {}
    for count in counts:
        ways = {"OpenMP": (1, count, "on"), "MPI, LIGGGHTS' loops": (count, 1, "off"),
                "MPI, particle subset": (count, 1, "on")}
        if count >= 8:
            ways["hybrid, 4 threads a rank"] = (count // 4, 4, "on")
        table[count] = {
            name: seconds_a_step(scene, GRANFLUX, threads, in_plane(ranks), ranks, steps, 1, ("-subset", subset))
            for name, (ranks, threads, subset) in ways.items()}
        print(f"{scene.title}, {count}: " +
              ", ".join(f"{name} {found['slowest']:.4f} s" for name, found in table[count].items()), file=sys.stderr)
    return table


def run_words(**variables):
    return [word for name, value in variables.items() for word in ("-var", name, str(value))]


def small_bed(folder, mixing, steps):
    """Gas in every particle step, as the paper has it, but for the mixing."""
    def prepare(scene, ranks):
        if not (scene.folder / "settled.restart").exists():
            measured_start(scene.folder, GRANFLUX, "-threads", str(CORES), "-in", "in.settle")
        words = run_words(timed=round(mixing / 5e-6), keep=1, couple_every=10, grid_x="*", grid_y="*", grid_z=1)
        measured_start(scene.folder, GRANFLUX, "-threads", "1", "-in", scene.script, *words, ranks=ranks)
        (scene.folder / "mixed.restart").rename(scene.folder / f"mixed{ranks}.restart")

    def timed(ranks, count):
        return run_words(start=f"mixed{ranks}.restart", timed=count, keep=0)

    def fresh(count):
        return run_words(timed=count, keep=0)

    return CoupledScene(folder, "small bed", "fluidized_bed", "in.small_bed", steps, prepare, timed, fresh,
                        ("grid_x", "grid_y", "grid_z"))


def large_bed(folder, title, size, mixing, steps):
    """Gas in every particle step, as the paper has it."""
    def prepare(scene, ranks):
        words = run_words(**size, mixing=mixing, timed=0, show=0, state=f"mixed{ranks}.restart")
        measured_start(scene.folder, GRANFLUX, "-threads", str(max(CORES // ranks, 1)), "-in", scene.script, *words,
                       ranks=ranks)

    def timed(ranks, count):
        return run_words(**size, resume=1, state=f"mixed{ranks}.restart", timed=count, show=0, couple_every=1)

    def fresh(count):
        return run_words(**size, mixing=mixing, timed=count, show=0, couple_every=1)

    return CoupledScene(folder, title, "large_bed", "in.large_bed", steps, prepare, timed, fresh,
                        ("grid_x", "grid_y", "grid_z"))


def kiln(folder, title, size, turned, steps):
    """Gas and heat in every particle step. The drum turns without gas first, so that any number of ranks can take the
    state up."""
    step = 2.5e-5  # s, as in.drum has it

    def prepare(scene, ranks):
        if (scene.folder / "turned").exists():
            return
        for script, words in (("in.settle", {}), ("in.turned", {"turned": round(turned / step)})):
            measured_start(scene.folder, GRANFLUX, "-threads", str(CORES), "-in", script, *run_words(**size, **words))
        (scene.folder / "turned").touch()

    def timed(ranks, count):
        return run_words(**{name: value for name, value in size.items() if name != "fill"}, timed=count, couple_every=1)

    def fresh(count):
        prepare(scene, 1)
        return timed(1, count)

    scene = CoupledScene(folder, title, "rotary_kiln", "in.kiln_timed", steps, prepare, timed, fresh, ("px", "py", "pz"))
    if size:  # as examples/rotary_kiln/run.sh makes the whole kiln of the section
        case = (folder / "kiln.toml").read_text()
        for key, value in (("length", size["length"]), ("cells", [5, 10, 15]), ("axial_blocks", 5)):
            case = re.sub(rf"^{key} = .*", f"{key} = {value}", case, flags=re.M)
        (folder / "kiln.toml").write_text(case)
    return scene


SMALL = {"floor": 192, "case": "gas_small"}
WHOLE_KILN = {"length": 76.2e-3, "particles": 100000, "fill": 19e-3}


def scenes(quick):
    """{title: (what it is, what the paper says, the scene in a folder, more for derived())}, cheap ones first."""
    size, what = (SMALL, "331 776 particles, 262 144 cells") if quick else ({}, "1.3 million particles, 1 million cells")
    found = {
        "Table 2: the small bed": (
            "9240 particles, 768 cells, 0.9 m/s, gas in every particle step.",
            "20 000 steps on 2 cores: gas 1550 s by OpenMP and 1585 by MPI, particles 1715 and 2075 (0.83); on 4 cores 1235 "
            "and 1265, 820 and 1310 (0.63).",
            lambda folder: small_bed(folder, 0.1 if quick else 0.5, 1000 if quick else 4000), None),
        "Table 5: the kiln's section": (
            "20 000 particles, 5 blocks of 900 cells in all, 20 rpm, gas and heat in every particle step.",
            "10 ms on 5 cores: 160 s by OpenMP, 330 s by MPI (0.48).",
            lambda folder: kiln(folder, "kiln section", {}, 0.1 if quick else 1, 200 if quick else 1000), None),
        "Table 5, Fig. 11: the whole kiln": (
            "100 000 particles, 25 blocks of 4500 cells in all, 20 rpm, gas and heat in every particle step.",
            "10 ms on 25 cores: 275 s by OpenMP, 445 s by MPI (0.62).",
            lambda folder: kiln(folder, "whole kiln", WHOLE_KILN, 0.1 if quick else 1, 50 if quick else 500), None),
        "Fig. 4: the large bed": (
            what + ", 2.6 m/s, gas in every particle step.",
            "on up to 16 cores the particles take by OpenMP less than half of the time by MPI; in all 20 to 30 % less on up to 32.",
            lambda folder: large_bed(folder, "large bed", size, 0.02 if quick else 0.1, 20 if quick else 50), None),
        "Fig. 11, strong scaling": (
            "The whole kiln, from the turned state.", "5 to 25 cores: by MPI and OpenMP, no numbers in the text.",
            lambda folder: kiln(folder, "kiln, scaling", WHOLE_KILN, 0.1 if quick else 1, 0),
            ((1, 5) if quick else (1, 5, 10, 15, 20, 25), (20, 100))),
        "Fig. 4, strong scaling": (
            "331 776 particles, 262 144 cells, from rest, gas in every particle step.",
            "particles scale to 64 cores, gas to 16.",
            lambda folder: large_bed(folder, "large bed, scaling", SMALL, 0.003, 0),
            ((1, 2, 4, 8) if quick else (1, 2, 4, 8, 16, 32, 64), (5, 45) if quick else (5, 85)))}
    if not quick:
        found["5.3 million particles"] = (
            "5.3 million particles, 1 million cells, 2.6 m/s, gas in every particle step.",
            "50 steps on 32 cores: particles 170 s by OpenMP, 330 s by MPI (0.52).",
            lambda folder: large_bed(folder, "deep bed", {"layers": 36}, 0.01, 50), None)
    return found


def paper(quick, only, done, keep):
    """Quick: the same scenes, smaller where the paper's are large, with fewer steps and rounds. `only`: a pattern of
    titles. `done`: scenes of an earlier run, which are not run again; keep(result) is called after each."""
    result = {"quick": quick, "rounds": 3 if quick else 5, "scenes": dict(done)}
    if not any(re.search(only, title) for title in scenes(quick)):
        sys.exit(f"--only {only}: of no scene; there are: {', '.join(scenes(quick))}")
    for title, (what, said, make, more) in scenes(quick).items():
        if title in done or not re.search(only, title):
            continue
        with tempfile.TemporaryDirectory() as top:
            scene = make(Path(top) / "scene")
            found = {"derived": derived(scene, *more)} if more else {"by_cores": by_cores(scene, result["rounds"])}
        result["scenes"][title] = {"what": what, "paper": said, **found}
        keep(result)
    return result
