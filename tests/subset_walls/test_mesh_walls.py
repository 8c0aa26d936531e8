# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Walls of triangles, at rest and moving, with and without stress: as in the stock program."""

import re
import unittest

from host import GRANFLUX, LIGGGHTS, thermo_rows
from beside_stock import SPHERES, STIFFNESS, STIFFNESS_WALL, BesideStock, run_and_dump

MOTION = """
fix             gravity all gravity 9.81 vector 0.3 0 -1
fix             move all nve/sphere
"""
CLEAR = """
region          inside block -7.4e-3 7.4e-3 -7.4e-3 7.4e-3 -7.4e-3 7.4e-3 side out units box
delete_atoms    region inside
region          ridge block -2.5e-3 2.5e-3 INF INF INF -5e-3 units box
delete_atoms    region ridge
"""
FINE = 4  # squares along an edge: most contacts then lie near edges and corners of triangles


def square(corner, u, v):
    """The parallelogram of u and v at a corner: FINE x FINE of them, of two triangles each."""
    at = lambda i, j: tuple(c + a * i / FINE + b * j / FINE for c, a, b in zip(corner, u, v))
    triangles = []
    for i in range(FINE):
        for j in range(FINE):
            p = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            triangles += [(p[0], p[1], p[2]), (p[0], p[2], p[3])]
    return triangles


def box(h=7.25e-3):
    """The six sides of a box of half-width h."""
    w = 2 * h
    found = square((-h, -h, -h), (w, 0, 0), (0, w, 0)) + square((-h, -h, h), (w, 0, 0), (0, w, 0))
    found += square((-h, -h, -h), (w, 0, 0), (0, 0, w)) + square((-h, h, -h), (w, 0, 0), (0, 0, w))
    found += square((-h, -h, -h), (0, w, 0), (0, 0, w)) + square((h, -h, -h), (0, w, 0), (0, 0, w))
    return found


def roof():
    """Its ridge, its ends and their corners are sharp."""
    foot, top, end, floor = 2.1e-3, -5.1e-3, 6.1e-3, -7.25e-3
    a, b = (-foot, -end, floor), (foot, -end, floor)
    c, d = (foot, end, floor), (-foot, end, floor)
    e, f = (0, -end, top), (0, end, top)
    return [(a, e, f), (a, f, d), (b, c, f), (b, f, e), (a, b, e), (d, f, c)]


def stl(triangles):
    lines = ["solid wall"]
    for corners in triangles:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.9g} {y:.9g} {z:.9g}" for x, y, z in corners]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid wall"]) + "\n"


class MeshWalls(BesideStock):
    def setUp(self):
        super().setUp()
        self.write("box.stl", stl(box()))
        self.write("roof.stl", stl(roof()))

    def script(self, spacing=2.2e-3, box="mesh/surface", roof_="mesh/surface", after="", more=""):
        return (SPHERES.format(spacing=spacing) + CLEAR + STIFFNESS +
                f"fix box all {box} file box.stl type 1\n"
                f"fix roof all {roof_} file roof.stl type 2\n" +
                STIFFNESS_WALL.format(id="walls",
                                      wall=f"mesh n_meshes 2 meshes box roof {more}") +
                MOTION + after + run_and_dump())

    def check_touching(self, script, **more):
        outputs = self.check(script, **more)
        self.assertGreater(self.wall_contacts(), 30)
        return outputs

    def test_at_rest(self):
        self.check_touching(self.script())

    def test_at_rest_dense(self):
        self.check_touching(self.script(spacing=1.25e-3))

    def test_moving(self):
        for move in ("linear 0 0 0.5", "rotate origin 0 0 0 axis 0 0 1 period 0.05",
                     "wiggle amplitude 0 0 3e-4 period 2e-3"):
            with self.subTest(move):
                self.check_touching(self.script(after=f"fix go all move/mesh mesh roof {move}\n"),
                                    mixes=[(1, 1), (1, 2), (2, 2)])

    def test_conveyor(self):
        """A wall that stands, with a velocity of its surface."""
        script = self.script().replace("file box.stl type 1",
                                       "file box.stl type 1 surface_vel 0.5 0 0")
        self.check_touching(script, mixes=[(1, 2), (2, 2)])

    def test_stress_and_wear(self):
        """Sums over contacts: force and torque on the mesh."""
        thermo = ("fix finnie all property/global k_finnie peratomtypepair 2 1 1 1 1\n"
                  "thermo_style custom step atoms f_box[1] f_box[2] f_box[3] f_box[4] f_box[5] "
                  "f_box[6] f_roof[1] f_roof[3]\n"
                  "thermo_modify lost ignore norm no format float %.17g\nthermo 20\n")
        script = self.script(box="mesh/surface/stress", roof_="mesh/surface/stress", after=thermo)
        script = script.replace("file box.stl type 1", "file box.stl type 1 wear finnie")
        for stock, found in self.check_touching(script).values():
            expected, rows = thermo_rows(stock), thermo_rows(found)
            self.assertEqual(len(expected), len(rows))
            self.assertGreater(len(rows), 5)
            for column in range(2, len(rows[0])):
                scale = max(abs(row[column]) for row in expected)
                self.assertGreater(scale, 0)
                for a, b in zip(expected, rows):
                    self.assertLessEqual(abs(a[column] - b[column]), 1e-10 * scale)

    def test_wear_of_all_steps(self):
        """Also of those whose particles nobody else looks at."""
        wear = ("fix finnie all property/global k_finnie peratomtypepair 2 1 1 1 1\n"
                "dump worn all mesh/gran/VTK 99 worn_*.vtk wear\n")
        script = self.script(box="mesh/surface/stress", roof_="mesh/surface/stress", after=wear)
        script = re.sub(r"(\.stl type \d)", r"\1 wear finnie", script)
        worn = []
        for program, options in ((LIGGGHTS, []), (GRANFLUX, ["-threads", "2"])):
            self.run_script(script, program=program, options=options)
            numbers = re.split(r"wear.*double", self.read("worn_99.vtk"))[1]
            worn.append([float(word) for word in numbers.split()])
        self.assertGreater(sum(value > 0 for value in worn[0]), 10)
        for expected, found in zip(*worn, strict=True):
            self.assertLessEqual(abs(found - expected), 1e-9 * max(worn[0]))

    def test_force_stored(self):
        self.check_touching(self.script(more="store_force yes"), mixes=[(1, 2)])


if __name__ == "__main__":
    unittest.main()
