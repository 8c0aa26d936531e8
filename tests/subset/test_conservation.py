# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Energy of elastic, frictionless spheres in a closed box; momentum of a periodic one."""

import itertools
import math
import unittest

from beside_stock import BesideStock, words
from host import GRANFLUX, LIGGGHTS
from packed_box import DIAMETER, data_file, script, snapshots

CELLS, SPACING = 6, 1.3  # spheres each way, mean diameters
WIDTH = CELLS * SPACING * DIAMETER
KN = {(1, 1): 1e3, (1, 2): 1e3, (2, 1): 1e3, (2, 2): 1.3e3}  # N/m
WALL_TYPE = 1
CHANCE = 3  # stock runs of other seeds lie a factor of two to either side
WAYS = [(1, 1), (1, 2), (2, 2)]  # ranks, threads


class Sphere:
    """What a dump leaves out, from a line of the data file: id type diameter density x y z."""

    def __init__(self, line):
        number, kind, diameter, density = line.split()[:4]
        self.number, self.kind, self.radius = int(number), int(kind), float(diameter) / 2
        self.mass = float(density) * 4 / 3 * math.pi * self.radius**3


def spheres_of(data):
    lines = data.split("Atoms\n\n")[1].split("\n\nVelocities")[0].splitlines()
    return [Sphere(line) for line in lines]


def sparse(text, between):
    """No gravity, a dump every `between` steps."""
    lines = [line for line in text.splitlines() if not line.startswith("fix             gravity")]
    return "\n".join(lines).replace("dump            d all custom 1 ", f"dump            d all custom {between} ") + "\n"


def energy(spheres, rows):
    """Of motion and of springs, J."""
    total = sum(0.5 * s.mass * sum(v * v for v in rows[s.number][3:6]) for s in spheres)
    for s in spheres:
        for x in rows[s.number][:3]:
            for gap in (x - s.radius, WIDTH - x - s.radius):
                total += 0.5 * KN[s.kind, WALL_TYPE] * min(gap, 0.0) ** 2
    by_place = sorted(spheres, key=lambda s: rows[s.number][0])
    for first, a in enumerate(by_place):
        xa = rows[a.number]
        for b in itertools.islice(by_place, first + 1, None):
            xb = rows[b.number]
            if xb[0] - xa[0] > 1.1 * DIAMETER:
                break
            overlap = a.radius + b.radius - math.dist(xa[:3], xb[:3])
            if overlap > 0:
                total += 0.5 * KN[a.kind, b.kind] * overlap**2
    return total


def momentum(spheres, rows):
    return [math.fsum(s.mass * rows[s.number][3 + d] for s in spheres) for d in range(3)]


class Conservation(BesideStock):
    def run_in(self, name, text, ranks, program, threads):
        options = ("-threads", str(threads)) if program == GRANFLUX else ()
        output = self.run_script(text.replace("NAME", name), ranks, program, options)
        self.assertEqual("contact forces by particle subset" in output, program == GRANFLUX)
        return snapshots(self.read(name))

    def energies(self, spheres, *run):
        """Of each dump, relative to the first."""
        found = [energy(spheres, rows) for _, rows in sorted(self.run_in(*run).items())]
        return [value / found[0] for value in found]

    def elastic_box(self, steps, between):
        """(spheres, script) of a box whose walls and spheres take no energy."""
        data = data_file(3 * (CELLS,), SPACING, 0.5, 0.0, 0.0)
        self.write("data.box", data)
        walls = "\n".join(
            f"fix {d}{side} all wall/gran model hooke/stiffness primitive type {WALL_TYPE} {d}plane {place!r}"
            for d in "xyz"
            for side, place in (("l", 0.0), ("h", WIDTH))
        )
        text = script("NAME", words("hooke/stiffness"), boundary="f f f", step=1e-5, more=walls, runs=(steps,))
        text = text.replace("gamman peratomtypepair 2 1500 1200 1200 900", "gamman peratomtypepair 2 0 0 0 0")
        return spheres_of(data), sparse(text, between)

    def test_energy_is_that_of_the_stock_program(self):
        """Until rounding has grown to other paths: the same error of the integration."""
        spheres, text = self.elastic_box(steps=600, between=20)
        stock = self.energies(spheres, "stock.txt", text, 1, LIGGGHTS, 1)
        self.assertGreater(max(abs(value - 1) for value in stock), 1e-5)  # there were collisions
        for ranks, threads in WAYS:
            ours = self.energies(spheres, "subset.txt", text, ranks, GRANFLUX, threads)
            for a, b in zip(stock, ours, strict=True):
                self.assertAlmostEqual(a, b, delta=1e-10)

    def test_energy_in_the_long_run(self):
        """A hundred collisions of each sphere: the error of each is random, and so is their sum."""
        spheres, text = self.elastic_box(steps=20000, between=200)

        def departure(*run):
            return max(abs(value - 1) for value in self.energies(spheres, *run))

        stock = max(departure("stock.txt", text, ranks, LIGGGHTS, 1) for ranks in (1, 2))
        for ranks, threads in WAYS:
            self.assertLess(departure("subset.txt", text, ranks, GRANFLUX, threads), CHANCE * stock)

    def test_momentum(self):
        """Whatever the laws: what acts on one sphere acts on the other."""
        data = data_file(3 * (CELLS,), 1.05, 0.5, 200.0, 0.0)
        spheres = spheres_of(data)
        self.write("data.box", data)
        model = words("hertz", "tangential history", "cohesion sjkr", "rolling_friction epsd2")
        text = sparse(script("NAME", model, runs=(2000,)), between=2000)
        for ranks, threads in WAYS:
            dumps = self.run_in("subset.txt", text, ranks, GRANFLUX, threads)
            first, last = dumps[min(dumps)], dumps[max(dumps)]
            scale = sum(s.mass * math.hypot(*first[s.number][3:6]) for s in spheres)
            self.assertGreater(max(abs(last[n][3] - first[n][3]) for n in first), 0.1)  # they collided
            for a, b in zip(momentum(spheres, first), momentum(spheres, last)):
                self.assertLess(abs(a - b) / scale, 1e-12)


if __name__ == "__main__":
    unittest.main()
