# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Hard cases of contacts alone, by the threads and by the stock program."""

import math
import unittest

from host import LIGGGHTS, thermo_rows
from scenes import HardCase, data_file, dump, gravity, head, lattice, walls

THERMO = "thermo_style custom step atoms ke\nthermo_modify lost {lost} norm no format float %.17g\nthermo {every}\n"
DENSITY = 1000.0


class Contacts(HardCase):
    def run_contacts(self, script, spheres, low, high, **run):
        self.write("data.spheres", data_file(spheres, low, high))
        return self.run_script(script, **run)

    def end_of(self, script, spheres, low, high, **run):
        output = self.run_contacts(script, spheres, low, high, **run)
        self.assertIn("granflux: contact forces by particle subset", output)
        return self.spheres_now()

    def test_equal_positions_are_refused_by_name(self):
        """The stock program goes on with numbers of no value."""
        spheres = lattice((2, 2, 2), 1e-3, 1e-3, DENSITY)
        spheres.append(spheres[0])
        script = head(1e-6, kn=500, gn=1e-3) + THERMO.format(lost="error", every=10) + "run 10\n"
        low, high = (0, 0, 0), (2e-3,) * 3
        if LIGGGHTS:
            self.assertIn("nan", self.run_contacts(script, spheres, low, high, program=LIGGGHTS))
        for ranks, threads in ((1, 1), (1, 2), (2, 1)):
            with self.subTest(ranks=ranks, threads=threads):
                code, output = self.start_scene(
                    script, spheres, low, high, ranks=ranks, options=("-threads", str(threads))
                )
                self.assertNotIn(code, (0, 124), output)
                self.assertIn("particles 1 and 9 are both at (0.0005, 0.0005, 0.0005) m", output)
                self.assertNotIn("nan", output)
        frozen = script.replace("run 10", "group held id 1 9\nfix held held freeze\nrun 10")
        self.assertNotIn("nan", self.run_contacts(frozen, spheres, low, high))

    def test_a_centre_on_a_wall_is_refused_by_name(self):
        """The stock program goes on with numbers of no value, or without the particle."""
        spheres = lattice((2, 2, 2), 1e-3, 1e-3, DENSITY)
        spheres[2] = (1e-3, DENSITY, (0.5e-3, 1.5e-3, 0.0), (0, 0, 0))
        low, high = (0, 0, -1e-3), (2e-3, 2e-3, 2e-3)
        corners = ((0, 0), (2e-3, 0), (0, 2e-3)), ((2e-3, 2e-3), (2e-3, 0), (0, 2e-3))
        faces = "".join(
            "facet normal 0 0 1\nouter loop\n" + "".join(f"vertex {x} {y} 0\n" for x, y in triangle) + "endloop\nendfacet\n"
            for triangle in corners
        )
        self.write("floor.stl", f"solid floor\n{faces}endsolid floor\n")
        mesh = "fix floor all mesh/surface file floor.stl type 1\n"
        mesh += "fix wall0 all wall/gran model hooke/stiffness tangential history mesh n_meshes 1 meshes floor absolute_damping on\n"
        begin = head(1e-6, boundary="p p f", kn=500, gn=1e-3)
        end = THERMO.format(lost="ignore", every=10) + "run 10\n"
        for what, floor in (("the wall", walls(["zplane 0.0"])), ("mesh floor", mesh)):
            for ranks, threads in ((1, 1), (1, 2), (2, 1)):
                with self.subTest(what=what, ranks=ranks, threads=threads):
                    code, output = self.start_scene(
                        begin + floor + end, spheres, low, high, ranks=ranks, options=("-threads", str(threads))
                    )
                    self.assertNotIn(code, (0, 124), output)
                    self.assertIn(
                        f"particle 3 at (0.0005, 0.0015, 0) m has its centre exactly on {what} of fix wall0", output
                    )
                    self.assertNotIn("nan", output)
            frozen = begin + floor + end.replace("run 10", "group held id 3\nfix held held freeze\nrun 10")
            self.assertNotIn("nan", self.run_contacts(frozen, spheres, low, high))

    def test_thousandfold_sizes(self):
        """2000 spheres of 20 um rain on one of 20 mm: every one of them bounces off it."""
        radius, small = 10e-3, 10e-6
        spheres = [(2 * radius, DENSITY, (0.0, 0.0, -radius), (0, 0, 0))]
        for i in range(50):
            for j in range(40):
                x, y = 25e-6 * (i - 25), 25e-6 * (j - 20)
                z = math.sqrt((radius + small + 1e-6) ** 2 - x * x - y * y) - radius
                spheres.append((2 * small, DENSITY, (x, y, z), (0, 0, -0.01)))
        script = (
            head(2e-7, boundary="f f f", kn=1, gn=0, mu=0, skin=10e-6)
            + "group big id 1\nfix hold big freeze\n"
            + THERMO.format(lost="error", every=500)
            + dump(1000)
            + "run 1000\n"
        )
        low, high = (-11e-3, -11e-3, -21e-3), (11e-3, 11e-3, 1e-3)
        one, two = (
            self.end_of(script, spheres, low, high, options=("-threads", threads)) for threads in ("1", "2")
        )
        self.assertEqual(one, two)
        for n, (x, y, z, vx, vy, vz) in one.items():
            if n > 1:
                self.assertGreater(math.sqrt(x * x + y * y + (z + radius) ** 2), radius + small)
                self.assertAlmostEqual(math.sqrt(vx * vx + vy * vy + vz * vz), 0.01, delta=3e-4)
                self.assertGreater(vz, 0.009)

    def test_all_in_one_corner_and_in_one_cell(self):
        """4000 spheres in a corner of a box a hundred times as wide, most of them in few cells of the
        search, as many threads as there are: the same bits."""
        spheres = lattice((20, 20, 10), 1.02e-3, 1e-3, DENSITY)
        spheres = [(d, r, x, (0.1 * math.sin(n), 0.1 * math.cos(7 * n), -0.2)) for n, (d, r, x, _) in enumerate(spheres)]
        spheres.append((12e-3, DENSITY, (1.0, 1.0, 1.0), (0, 0, 0)))  # makes the cells wide
        script = (
            head(1e-5, boundary="f f f", kn=500, gn=2e-3, skin=3e-4)
            + walls(["xplane 0", "yplane 0", "zplane 0", "xplane 2", "yplane 2", "zplane 2"])
            + gravity()
            + THERMO.format(lost="error", every=100)
            + dump(100)
            + "run 100\n"
        )
        ends = [
            self.end_of(script, spheres, (0, 0, 0), (2, 2, 2), options=("-threads", str(threads))) for threads in (1, 3)
        ]
        self.assertEqual(*ends)

    def test_lost_particles(self):
        """Those that leave a fixed box are gone or an error, as the script says, on any threads."""
        spheres = [(d, r, x, (0, 0, 20.0 if n % 2 else 0)) for n, (d, r, x, _) in enumerate(lattice((4, 4, 4), 1e-3, 1e-3, DENSITY))]
        for lost in ("ignore", "error"):
            script = head(1e-5, boundary="f f f", kn=500, gn=1e-3) + THERMO.format(lost=lost, every=10) + "run 100\n"
            for threads in ("1", "2"):
                code, output = self.start_scene(
                    script, spheres, (0, 0, 0), (4e-3,) * 3, options=("-threads", threads)
                )
                if lost == "ignore":
                    self.assertEqual(code, 0, output)
                    self.assertLess(thermo_rows(output)[-1][1], 64)
                else:
                    self.assertNotEqual(code, 0)
                    self.assertIn("Lost atoms", output)


if __name__ == "__main__":
    unittest.main()
