# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Gas that starts at once, flows back, is very fast, very hot, or has nothing to do."""

import math
import re
import unittest

from host import couple
from scenes import AIR, GRAVITY, HardCase, box, dump, energy, gravity, head, heat, lattice, thermo, volume, walls

DIAMETER, DENSITY, NUMBER = 1e-3, 1000.0, 8
SIDE = NUMBER * DIAMETER


class SuddenInlet(HardCase):
    def test_pressure_drop_settles_at_the_weight(self):
        """Gas at twice the velocity of minimum fluidization, all at once, under a bed at rest in a duct
        so narrow that it moves up as a plug."""
        height = 40e-3
        sides = {"z_low": 'type = "inlet"\nvelocity = [0, 0, 0.6]', "z_high": 'type = "outlet"'}
        case = box((SIDE, SIDE, height), (4, 4, 20), AIR, sides)
        spheres = lattice((NUMBER, NUMBER, 6), DIAMETER, DIAMETER, DENSITY)
        script = (
            head(1e-5, boundary="p p f", kn=500, gn=5e-3, skin=3e-4)
            + walls(["zplane 0"])
            + gravity()
            + couple(10)
            + thermo(10)
        )
        rows, _ = self.run_scene(script + "run 2500\n", spheres, (0, 0, 0), (SIDE, SIDE, height), case)
        weight = len(spheres) * volume(DIAMETER) * (DENSITY - AIR["density"]) * GRAVITY / SIDE**2
        drops = [row.gas[1] / weight for row in rows]
        for drop in drops:
            self.assertTrue(0.9 < drop < 1.5, drop)  # lifting it takes a little more than its weight
        self.assertAlmostEqual(drops[-1], 1, delta=0.02)


class Backflow(HardCase):
    def test_gas_flows_in_through_an_outlet(self):
        """Spheres that fall fast from one open end to the other drag gas in through the outlet above."""
        height = 40e-3
        sides = {
            "z_low": 'type = "outlet"\ntemperature = 500',
            "z_high": 'type = "outlet"\ntemperature = 500',
            **{side: 'type = "slip"' for side in ("x_low", "x_high", "y_low", "y_high")},
        }
        case = box((SIDE, SIDE, height), (4, 4, 20), AIR, sides, energy(300))
        spheres = lattice((NUMBER // 2, NUMBER // 2, 6), 2 * DIAMETER, DIAMETER, DENSITY, (0, 0, -3.0), (0, 0, 25e-3))
        script = (
            head(1e-5, boundary="f f f", kn=500, gn=5e-3, skin=3e-4)
            + gravity()
            + heat(400, 500)
            + couple(10)
            + thermo(10)
            + dump(10, "f_Temp f_gasTemperature f_uf[3]")
        )
        rows, _ = self.run_scene(script + "run 600\n", spheres, (0, 0, 0), (SIDE, SIDE, height), case)
        least = 0
        for line in self.read("dump.spheres").splitlines():
            words = line.split()
            if len(words) == 10 and words[0].isdigit() and float(words[8]) > 0:
                warm, gas, u = map(float, words[7:])
                self.assertTrue(300 - 1e-9 <= warm <= 500 + 1e-9, line)
                self.assertTrue(300 - 1e-9 <= gas <= 500 + 1e-9, line)
                self.assertTrue(-3.2 < u < 0.5, line)  # up: what they displace
                least = min(least, u)
        self.assertLess(least, -0.05)  # it does flow in
        self.assertLess(rows[-1].gas[24], 0)


class Fast(HardCase):
    def test_reynolds_number_of_a_hundred_thousand(self):
        """A held sphere in gas at 150 m/s: Newton's law of drag at the velocity that it sees."""
        diameter, velocity, side = 10e-3, 150.0, 0.2
        sides = {
            "z_low": f'type = "inlet"\nvelocity = [0, 0, {velocity}]',
            "z_high": 'type = "outlet"',
            **{name: 'type = "slip"' for name in ("x_low", "x_high", "y_low", "y_high")},
        }
        more = f"[initial]\nvelocity = [0, 0, {velocity}]\n"
        case = box((side, side, 2 * side), (8, 8, 16), AIR, sides, more)
        script = (
            head(1e-6, boundary="f f f", skin=1e-3)
            + "fix held all freeze\n"
            + couple(20)
            + thermo(20)
            + dump(20, "f_dragforce[3] f_uf[3] f_voidfraction")
        )
        spheres = [(diameter, DENSITY, (side / 2, side / 2, side / 2), (0, 0, 0))]
        rows, _ = self.run_scene(script + "run 2000\n", spheres, (0, 0, 0), (side, side, 2 * side), case)
        force, u, void = self.spheres_now()[1][6:]
        reynolds = AIR["density"] * u * diameter / AIR["viscosity"]
        self.assertGreater(reynolds, 9e4)
        newton = 0.44 * math.pi / 8 * diameter**2 * AIR["density"] * u**2
        # Wen and Yu's law, with its factor for the other spheres that a little of the void stands for.
        self.assertAlmostEqual(force / newton, void**-2.65, delta=2e-3)
        self.assertLess(rows[-1].gas[15], 0.3)


class Nothing(HardCase):
    def test_no_gravity_no_flow_no_motion(self):
        """Spheres that just touch, in gas at rest, without gravity: nothing moves, to the last bit."""
        case = box((SIDE,) * 3, (4, 4, 4), AIR)
        spheres = lattice((NUMBER,) * 3, DIAMETER, 0.999 * DIAMETER, DENSITY)
        script = head(1e-5, kn=500, gn=5e-3, skin=3e-4) + couple(10) + thermo(10) + "run 200\n"
        rows, output = self.run_scene(script, spheres, (0, 0, 0), (SIDE,) * 3, case)
        self.assertTrue(re.search("no gravity: neither the script .* nor the gas case gives any", output))
        for row in rows:
            self.assertEqual((row.kinetic, *row.momentum, *row.gas[2:8], *row.gas[22:25]), (0,) * 13)


class HotAndCold(HardCase):
    def test_jump_of_a_thousand_kelvin(self):
        """Gas of 1300 K into a bed of 300 K, and the other way round: no temperature beyond the two."""
        sides = {"z_low": 'type = "inlet"\nvelocity = [0, 0, 0.5]\ntemperature = {}', "z_high": 'type = "outlet"'}
        spheres = lattice((4, 4, NUMBER), DIAMETER, DIAMETER, DENSITY)
        size = (4 * DIAMETER, 4 * DIAMETER, 2 * SIDE)
        for bed, gas in ((300, 1300), (1300, 300)):
            with self.subTest(bed=bed, gas=gas):
                inlet = {name: text.format(gas) for name, text in sides.items()}
                case = box(size, (2, 2, 16), AIR, inlet, energy(gas))
                script = (
                    head(1e-5, boundary="p p f", kn=500, gn=5e-3, skin=3e-4)
                    + "fix held all freeze\n"
                    + heat(bed, 5)  # so little that the front passes
                    + couple(10)
                    + thermo(10)
                    + dump(50, "f_Temp f_gasTemperature")
                )
                rows, _ = self.run_scene(script + "run 4000\n", spheres, (0, 0, 0), size, case)
                low, high = sorted((bed, gas))
                for line in self.read("dump.spheres").splitlines():
                    words = line.split()
                    if len(words) == 9 and words[0].isdigit() and float(words[8]) > 0:
                        for temperature in map(float, words[7:]):
                            self.assertTrue(low - 1e-9 <= temperature <= high + 1e-9, line)
                end = self.spheres_now()
                self.assertLess(abs(end[1][6] - gas), 1)  # through with the first, not yet with the last
                self.assertGreater(abs(end[128][6] - gas), 300)


if __name__ == "__main__":
    unittest.main()
