# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Particles and the cells they lie in: across faces, large and small, crammed, on corners."""

import math
import random
import unittest

from host import couple
from scenes import AIR, GRAVITY, HardCase, box, dump, gravity, head, lattice, thermo, volume, walls

DIAMETER, DENSITY = 1e-3, 1000.0
OPEN_TOP = {
    **{side: 'type = "slip"' for side in ("x_low", "x_high", "y_low", "y_high", "z_low")},
    "z_high": 'type = "outlet"',
}
COLUMN = {"z_low": 'type = "inlet"\nvelocity = [0, 0, {}]', "z_high": 'type = "outlet"'}


def ergun(void, velocity, diameter=DIAMETER):
    """Pressure gradient of a packed bed at a superficial velocity [Pa/m]."""
    mu, rho, solids = AIR["viscosity"], AIR["density"], 1 - void
    laminar = 150 * solids**2 * mu * velocity / (void**3 * diameter**2)
    return laminar + 1.75 * solids * rho * velocity**2 / (void**3 * diameter)


def wen_yu(void, velocity, diameter):
    """The same of a loose bed [Pa/m]."""
    rho, reynolds = AIR["density"], AIR["density"] * velocity * diameter / AIR["viscosity"]
    resistance = 24 / reynolds * (1 + 0.15 * reynolds**0.687)
    return 0.75 * resistance * (1 - void) * rho * velocity**2 / diameter * void**-3.65 / void


class Crossing(HardCase):
    """A sphere too heavy to be slowed down moves through still gas, across a face between cells."""

    SIZE, CELLS, FACE, SPEED = (4e-3, 4e-3, 60e-3), (2, 2, 6), 30e-3, 0.1

    def largest_pressure_force(self, kernel, dt):
        """On the sphere while it crosses the face, long after it set the gas going."""
        before, after = 400, 20  # steps
        start = self.FACE - (before - 0.5) * dt * self.SPEED
        spheres = [(1.2e-3, 1e9, (1e-3, 1e-3, start), (0, 0, self.SPEED))]
        case = box(self.SIZE, self.CELLS, AIR, OPEN_TOP, f'[coupling]\nvoid_fraction = "{kernel}"\n')
        script = head(dt, boundary="f f f") + couple(1) + thermo(1) + f"run {before + after}\n"
        rows, _ = self.run_scene(script, spheres, (0, 0, 0), self.SIZE, case)
        return max(abs(row.gas[7]) for row in rows[before - after :])

    def test_force_is_bounded_as_steps_become_short(self):
        steps = (1e-4, 1e-5, 1e-6)
        found = {
            kernel: [self.largest_pressure_force(kernel, dt) for dt in steps]
            for kernel in ("centre", "trilinear", "smoothed")
        }
        weight = 1000 * volume(1.2e-3) * GRAVITY
        for kernel, forces in found.items():
            print(f"{kernel}: largest pressure force over weight", *(f"{f / weight:.2e}" for f in forces))
        for kernel in ("trilinear", "smoothed"):
            self.assertLess(max(found[kernel]), 1e-4 * weight)
        # All of the sphere in one step: rho h^2 (V_p / V) / dt^2 of pressure.
        jumps = found["centre"]
        self.assertGreater(jumps[1], 50 * jumps[0])
        self.assertGreater(jumps[2], 50 * jumps[1])
        self.assertGreater(jumps[2], weight)


class Sizes(HardCase):
    """A bed whose particles are 0.3, 1 and 2 times as large as a cell, and lie anywhere in it."""

    NUMBER = 8

    def bed(self, cells, kernel, velocity=0.2, every=10, steps=300):
        side = self.NUMBER * DIAMETER
        rng = random.Random(5)
        spheres = [
            (d, rho, tuple(c + 0.05 * DIAMETER * rng.uniform(-1, 1) for c in x), v)
            for d, rho, x, v in lattice((self.NUMBER,) * 3, DIAMETER, DIAMETER, DENSITY)
        ]
        sides = {name: text.format(velocity) for name, text in COLUMN.items()}
        case = box((side,) * 3, cells, AIR, sides, f'[coupling]\nvoid_fraction = "{kernel}"\n')
        script = (
            head(1e-5, boundary="p p f", kn=500, gn=5e-3, skin=3e-4)
            + "group held id > 0\nfix held held freeze\n"
            + couple(every)
            + thermo(every)
        )
        return (script + f"run {steps}\n", spheres, (0, 0, 0), (side,) * 3, case)

    def test_pressure_drop_on_any_grid(self):
        expected = ergun(1 - math.pi / 6, 0.2) * self.NUMBER * DIAMETER
        for cells, kernel in (
            ((3, 3, 3), "trilinear"),  # 0.375 of a cell
            ((8, 8, 8), "trilinear"),  # 1
            ((8, 8, 8), "divided"),
            ((8, 8, 8), "smoothed"),
            ((16, 16, 16), "smoothed"),  # 2
        ):
            with self.subTest(cells=cells, kernel=kernel):
                rows, _ = self.run_scene(*self.bed(cells, kernel))
                self.assertAlmostEqual(rows[-1].gas[1] / expected, 1, delta=0.01)

    def test_no_room_for_gas_is_an_error_that_names_the_cell_and_the_cure(self):
        for kernel in ("centre", "divided"):
            with self.subTest(kernel=kernel):
                code, output = self.start_scene(*self.bed((16, 16, 16), kernel))
                self.assertNotIn(code, (0, 124))
                self.assertRegex(output, r"void fraction -?[0-9.]+ in cell \(\d+, \d+, \d+\) of block 0")
                self.assertIn("is below void_fraction_floor = 0.05", output)
                self.assertIn("smoothing_width", output)
                self.assertNotIn("nan", output)


class ClosePacking(HardCase):
    """Hexagonal layers, the densest there are: a void fraction of 0.2595, below what any drag law was
    measured at."""

    ACROSS, ROWS, LAYERS = 6, 6, 9
    SPACING = 1.0 - 1e-7  # pressed together a little

    def run_layers(self, cells, kernel, velocity=0.3):
        d = DIAMETER * self.SPACING
        row, layer = math.sqrt(3) / 2 * d, math.sqrt(2 / 3) * d
        size = (self.ACROSS * d, self.ROWS * row, self.LAYERS * layer)
        spheres = []
        for k in range(self.LAYERS):  # every second layer in the hollows of the others
            for j in range(self.ROWS):
                for i in range(self.ACROSS):
                    x = (i + 0.5 * (j % 2) + 0.5 * (k % 2)) * d % size[0]
                    y = (j + (k % 2) / 3) * row % size[1]
                    spheres.append((DIAMETER, DENSITY, (x, y, (k + 0.5) * layer), (0, 0, 0)))
        low = (0, 0, -0.1 * DIAMETER)
        high = (*size[:2], size[2] + 0.1 * DIAMETER)
        sides = {name: text.format(velocity) for name, text in COLUMN.items()}
        case = box(size, cells, AIR, sides, f'[coupling]\nvoid_fraction = "{kernel}"\n')
        script = (
            head(1e-5, boundary="p p f", kn=500, gn=5e-3, skin=3e-4)
            + walls([f"zplane {0.5 * layer - 0.5 * d}"])
            + gravity()
            + couple(10)
            + thermo(10)
            + dump(1000)
        )
        return (script + "run 1000\n", spheres, low, high, case), size[2]

    def test_pressure_drop(self):
        void, velocity = 1 - math.pi / math.sqrt(18), 0.03
        scene, height = self.run_layers((2, 2, 3), "trilinear", velocity)
        rows, _ = self.run_scene(*scene)
        expected = ergun(void, velocity) * height
        self.assertLess(expected, 0.6 * (1 - void) * DENSITY * GRAVITY * height)
        self.assertAlmostEqual(rows[-1].gas[8], void, delta=1e-3)
        self.assertEqual(rows[-1].gas[18], rows[-1].gas[16])  # the law is out of its range, and says so
        self.assertAlmostEqual(rows[-1].gas[1] / expected, 1, delta=0.005)

    def test_two_centres_in_a_cell(self):
        scene, _ = self.run_layers((6, 5, 7), "centre")
        code, output = self.start_scene(*scene)
        self.assertNotIn(code, (0, 124))
        self.assertRegex(output, r"void fraction -?[0-9.]+ in cell \(\d+, \d+, \d+\) of block 0")
        self.assertIn("is below void_fraction_floor = 0.05", output)


class Crammed(HardCase):
    def test_thousands_in_a_cell_and_empty_cells(self):
        """4096 spheres in one cell of eight, the others empty, and all of the gas pushed by them."""
        side, number = 4e-3, 16
        spheres = lattice((number,) * 3, side / 2 / number, 0.1e-3, 2500, (0.0, 0.0, 0.1))
        case = box((side,) * 3, (2, 2, 2), AIR)
        script = head(1e-5, kn=50, gn=1e-5, skin=1e-4) + couple(10) + thermo(20) + "run 200\n"
        rows, _ = self.run_scene(script, spheres, (0, 0, 0), (side,) * 3, case)
        self.assertEqual(rows[-1].gas[16], number**3)
        self.assertAlmostEqual(rows[-1].gas[8], 1 - number**3 * volume(0.1e-3) / (side / 2) ** 3, delta=0.2)
        for row, later in zip(rows, rows[1:]):
            self.assertTrue(0 < later.velocity[2] < row.velocity[2])
            self.assertTrue(0 <= row.gas[24] <= later.gas[24])


class Corners(HardCase):
    def test_on_corners_of_blocks_of_a_box(self):
        """Spheres exactly on corners, edges and faces where blocks of several ranks meet."""
        size = (8e-3, 8e-3, 8e-3)
        spheres = [
            (0.5e-3, DENSITY, (x, y, z), (0, 0, 0)) for x in (2e-3, 4e-3) for y in (2e-3, 4e-3) for z in (3e-3, 4e-3)
        ]
        for kernel in ("centre", "trilinear", "divided"):
            case = box(size, (4, 4, 4), AIR, OPEN_TOP, f'[coupling]\nvoid_fraction = "{kernel}"\n')
            case = case.replace("cells", "blocks = [2, 2, 2]\ncells")
            ends = []
            for ranks in (1, 2):
                script = head(1e-5, boundary="f f f", kn=50, gn=1e-5) + gravity() + couple(5) + thermo(10) + dump(20)
                rows, _ = self.run_scene(script + "run 20\n", spheres, (0, 0, 0), size, case, ranks=ranks)
                self.assertEqual(rows[-1].gas[16], len(spheres))
                ends.append(self.spheres_now())
            for n, row in ends[0].items():
                for a, b in zip(row, ends[1][n]):
                    self.assertAlmostEqual(a, b, delta=1e-12, msg=kernel)

    def test_on_corners_of_a_body_fitted_grid(self):
        """On the axis, on the corners of the core, on the middles of its sides, on a node of the wall."""
        radius, length, core = 10e-3, 8e-3, 0.625
        case = f"""
[grid]
kind = "cylinder"
radius = {radius}
length = {length}
cells = [2, 4, 4]
axial_blocks = 2
[fluid]
density = 1.2
viscosity = 1.8e-5
[[boundary]]
name = "wall"
type = "wall"
[[boundary]]
name = "low"
type = "wall"
[[boundary]]
name = "high"
type = "outlet"
"""
        diagonal = core * radius * math.sqrt(0.5)
        rim = radius * math.sqrt(0.5) * (1 - 1e-12)
        places = [(0.0, 0.0)]
        places += [(a * diagonal, b * diagonal) for a in (-1, 1) for b in (-1, 1)]
        places += [(a * rim, b * rim) for a in (-1, 1) for b in (-1, 1)]
        spheres = [(0.5e-3, DENSITY, (x, y, z), (0, 0, 0)) for x, y in places for z in (2e-3, 4e-3)]
        low, high = (-radius, -radius, 0), (radius, radius, length)
        for kernel in ("centre", "smoothed"):
            ends = []
            for ranks in (1, 4):
                script = head(1e-5, boundary="f f f", kn=50, gn=1e-5) + gravity() + couple(5) + thermo(10) + dump(20)
                rows, _ = self.run_scene(
                    script + "run 20\n",
                    spheres,
                    low,
                    high,
                    case + f'[coupling]\nvoid_fraction = "{kernel}"\n',
                    ranks=ranks,
                )
                self.assertEqual(rows[-1].gas[16] + rows[-1].gas[17], len(spheres))
                self.assertEqual(rows[-1].gas[17], 0)
                ends.append(self.spheres_now())
            for n, row in ends[0].items():
                for a, b in zip(row, ends[1][n]):
                    self.assertAlmostEqual(a, b, delta=1e-12, msg=kernel)


class FlatCells(HardCase):
    def test_aspect_ratio_of_a_hundred(self):
        """Cells of 100 : 1, flat and long, give the pressure drop of a uniform bed."""
        for cells, size in (((2, 2, 20), (20e-3, 20e-3, 2e-3)), ((20, 20, 2), (2e-3, 2e-3, 20e-3))):
            with self.subTest(cells=cells):
                spacing, diameter, velocity = 0.2e-3, 0.1e-3, 0.5
                numbers = [round(length / spacing) for length in size]
                spheres = lattice(numbers, spacing, diameter, 2500)
                sides = {name: text.format(velocity) for name, text in COLUMN.items()}
                more = '[coupling]\nvoid_fraction = "smoothed"\nsmoothing_width = 4\n'
                case = box(size, cells, AIR, sides, more)
                script = (
                    head(1e-6, boundary="p p f", kn=1, skin=5e-5)
                    + "group held id > 0\nfix held held freeze\n"
                    + couple(20)
                    + thermo(100)
                )
                rows, _ = self.run_scene(script + "run 1000\n", spheres, (0, 0, 0), size, case)
                expected = wen_yu(1 - volume(diameter) / spacing**3, velocity, diameter) * size[2]
                for row in rows[1:]:
                    self.assertAlmostEqual(row.gas[1] / expected, 1, delta=1e-3)


if __name__ == "__main__":
    unittest.main()
