# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Conduction through contacts of spheres that are held in place, against closed forms."""

import math
import unittest

from host import HostTest, last_snapshot, thermo_rows
from warm_spheres import data_file, head, mass, thermo, wall

DIAMETER, DENSITY, CONDUCTIVITY, CAPACITY = 2e-3, 3900, 36, 875
STIFFNESS, FORCE = 1e3, 1e-3
OVERLAP = FORCE / STIFFNESS
MODULUS = 4 / 3 / (2 * (1 - 0.3**2) / 193.05e9)
TEMPERATURES = 'dump d all custom {every} temperatures id f_Temp\ndump_modify d sort id format "%d %.17g"\n'


def contact_radius(reduced_radius):
    return (FORCE * reduced_radius / MODULUS) ** (1 / 3)


def square(x_plane, name, low=-5e-3, high=5e-3):
    """A plate of two triangles across x, as the text of an STL file."""
    a, b, c, d = ((x_plane, y, z) for y, z in ((low, low), (high, low), (high, high), (low, high)))
    text = f"solid {name}\n"
    for corners in ((a, b, c), (a, c, d)):
        text += "facet normal 1 0 0\nouter loop\n"
        text += "".join("vertex {!r} {!r} {!r}\n".format(*corner) for corner in corners)
        text += "endloop\nendfacet\n"
    return text + f"endsolid {name}\n"


class TwoSpheres(HostTest):
    """They exchange heat at the rate 2 H / (m c) and keep their mean."""

    def run_pair(self, words, steps=200, dt=0.5, capacity=CAPACITY, second=DIAMETER, sub=1000):
        place = DIAMETER / 2 + second / 2 - OVERLAP
        self.write("data.spheres", data_file([(1, DIAMETER, DENSITY, (0.0, 0.0, 0.0)), (2, second, DENSITY, (place, 0.0, 0.0))]))
        self.run_script(
            head(kn=STIFFNESS, dt=dt / sub)
            + "group hot id 2\nfix hold all freeze\n"
            + f"fix heat all granflux/heat initial_temperature 298 {words}\n"
            + "run 0\nset group hot property/atom Temp 373\n"
            + TEMPERATURES.format(every=steps * sub)
            + thermo("f_heat[1]", steps * sub)
            + f"run {steps * sub}\n"
        )
        return [row[0] for row in last_snapshot(self.read("temperatures")).values()]

    def test_hertz_and_geometric(self):
        # Published: after 50 s. Euler's error in dt = 1e-3 s is 1e-4 K; from two steps to none.
        for words, expected in (
            ("conduction hertz", (318.0906, 352.9094)),
            ("conduction geometric", (321.2385, 349.7615)),
        ):
            with self.subTest(words=words):
                cold, hot = self.run_pair(words, steps=50, dt=1)
                self.assertAlmostEqual(cold, expected[0], delta=2.5e-4)
                self.assertAlmostEqual(hot, expected[1], delta=2.5e-4)
                longer = self.run_pair(words, steps=50, dt=1, sub=500)
                for found, doubled, wanted in zip((cold, hot), longer, expected):
                    self.assertAlmostEqual(2 * found - doubled, wanted, delta=1e-4)
                self.assertAlmostEqual(cold + hot, 2 * 335.5, delta=1e-11)

    def test_the_law_to_the_step(self):
        # Euler's forward steps themselves: T2 - T1 = 75 (1 - 2 H dt / C)^n, to round-off.
        steps, dt = 100, 0.05
        per_radius = 2 * CONDUCTIVITY
        reduced = DIAMETER / 4
        radii = {
            "hertz": contact_radius(reduced),
            "geometric": contact_radius(DIAMETER / 2),
            "overlap": math.sqrt(reduced * OVERLAP),
            "stock": math.sqrt(math.pi * (DIAMETER**2 - (DIAMETER - OVERLAP) ** 2) / 4),
        }
        for name, radius in radii.items():
            with self.subTest(name=name):
                cold, hot = self.run_pair(f"conduction {name} friction off", steps, dt, sub=1)
                factor = 1 - 2 * per_radius * radius * dt / (mass(DIAMETER, DENSITY) * CAPACITY)
                # 1e-9: the overlap of 1e-6 m is a difference of places of 1e-3 m
                self.assertAlmostEqual((hot - cold) / (75 * factor**steps), 1, delta=1e-9)

    def test_spheres_of_two_sizes(self):
        # 100 s in steps of 0.02 s: the colder, larger one of mass 8.
        steps, dt = 5000, 0.02
        small, large = DIAMETER, 2 * DIAMETER
        cold, hot = self.run_pair("", steps, dt, second=large, sub=1)  # the second is at 373 K
        m1, m2 = mass(small, DENSITY), mass(large, DENSITY)
        conductance = 2 * CONDUCTIVITY * contact_radius(small * large / 2 / (small + large))
        a, b = conductance / (m1 * CAPACITY), conductance / (m2 * CAPACITY)
        factor = (1 - (a + b) * dt) ** steps
        expected = (b * 298 + a * 373 + a * (298 - 373) * factor) / (a + b)
        self.assertAlmostEqual(cold, expected, delta=1e-7)
        self.assertAlmostEqual(m1 * cold + m2 * hot, m1 * 298 + m2 * 373, delta=1e-13 * m2 * 373)

    def test_a_fixed_temperature_stays(self):
        cold, hot = self.run_pair("fixed_temperature hot", 2000, 0.05, sub=1)
        self.assertEqual(hot, 373)
        factor = 1 - 2 * CONDUCTIVITY * contact_radius(DIAMETER / 4) * 0.05 / (mass(DIAMETER, DENSITY) * CAPACITY)
        self.assertAlmostEqual((373 - cold) / (75 * factor**2000), 1, delta=1e-9)


class LineOfSpheres(HostTest):
    """Between a hot and a cold wall: in the steady state every contact passes the same heat."""

    COUNT, HOT, COLD = 6, 400, 300

    def run_line(self, walls, processors=1, words="", count=COUNT, steps=2000):
        pitch = DIAMETER - OVERLAP
        first = DIAMETER / 2 - OVERLAP
        self.end = first + (count - 1) * pitch + DIAMETER / 2 - OVERLAP
        self.write(
            "data.spheres",
            data_file([(1, DIAMETER, DENSITY, (first + n * pitch, 0.0, 0.0)) for n in range(count)]),
        )
        self.write("hot.stl", square(0.0, "hot"))
        self.write("cold.stl", square(self.end, "cold"))
        output = self.run_script(
            head(kn=STIFFNESS, dt=5, capacity=CAPACITY)
            + walls.replace("END", repr(self.end))
            + f"fix hold all move linear 0 0 0\nfix heat all granflux/heat initial_temperature 340 {words}\n"
            + TEMPERATURES.format(every=steps)
            + thermo("f_heat[7] f_heat[15] f_heat[22] f_heat[4] f_heat[5] f_heat[14]", steps)
            + f"run {steps}\n",
            ranks=processors,
        )
        return [row[0] for row in last_snapshot(self.read("temperatures")).values()], thermo_rows(output)[-1]

    def primitive(self):
        return wall("left", "xplane 0", more=f"temperature {self.HOT}") + wall(
            "right", "xplane END", more=f"temperature {self.COLD}"
        )

    def mesh(self):
        text = ""
        for name, temperature in (("hot", self.HOT), ("cold", self.COLD)):
            text += f"fix {name} all mesh/surface file {name}.stl type 1 temperature {temperature}\n"
        return text + (
            "fix walls all wall/gran model hooke/stiffness tangential history mesh n_meshes 2 "
            "meshes hot cold absolute_damping on\n"
        )

    def expected(self):
        pair = 1 / (2 * CONDUCTIVITY * contact_radius(DIAMETER / 4))
        at_wall = 1 / (2 * CONDUCTIVITY * contact_radius(DIAMETER / 2))
        heat = (self.HOT - self.COLD) / (2 * at_wall + (self.COUNT - 1) * pair)
        return [self.HOT - heat * (at_wall + n * pair) for n in range(self.COUNT)], at_wall, pair

    def test_primitive_and_mesh_walls(self):
        expected, at_wall, pair = self.expected()
        for walls in (self.primitive(), self.mesh()):
            temperatures, row = self.run_line(walls)
            for found, wanted in zip(temperatures, expected):
                self.assertAlmostEqual(found, wanted, delta=1e-6)
            self.assertAlmostEqual(row[2], 0, delta=1e-9)  # what walls give in all
            self.assertAlmostEqual(row[4], 0, delta=1e-12)  # heat not accounted for
            conductances = [1 / at_wall + 1 / pair, 2 / pair]
            biot = [c / (math.pi * CONDUCTIVITY * DIAMETER / 2) for c in conductances]
            self.assertAlmostEqual(row[6] / max(biot), 1, delta=1e-8)
            self.assertAlmostEqual(row[5] / ((2 * biot[0] + 4 * biot[1]) / 6), 1, delta=1e-8)

    def test_two_ranks(self):
        one, _ = self.run_line(self.primitive(), steps=200)
        two, _ = self.run_line(self.primitive(), processors=2, steps=200)
        for a, b in zip(one, two):
            self.assertAlmostEqual(a, b, delta=1e-10)

    def test_adiabatic_walls(self):
        walls = wall("left", "xplane 0", more=f"temperature {self.HOT}") + wall("right", "xplane END")
        temperatures, _ = self.run_line(walls, count=2)
        for found in temperatures:
            self.assertAlmostEqual(found, self.HOT, delta=1e-6)


if __name__ == "__main__":
    unittest.main()
