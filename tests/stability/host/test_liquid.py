# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Particles hardly heavier than the fluid, as heavy, and lighter."""

import math
import unittest

from host import couple
from scenes import GRAVITY, WATER, HardCase, box, dump, gravity, head, lattice, thermo, volume

RATIOS = (1.05, 1.0, 0.5)


class OneSphere(HardCase):
    def test_terminal_velocity(self):
        """Stokes drag, in water open above: 50 um, sinking, hovering, rising."""
        diameter, side = 50e-6, 8e-3
        sides = {name: 'type = "slip"' for name in ("x_low", "x_high", "y_low", "y_high", "z_low")}
        sides["z_high"] = 'type = "outlet"'
        case = box((side,) * 3, (4, 4, 4), WATER, sides, '[coupling]\ndrag = "stokes"\n')
        for ratio in RATIOS:
            with self.subTest(ratio=ratio):
                density = ratio * WATER["density"]
                terminal = -(density - WATER["density"]) * diameter**2 * GRAVITY / (18 * WATER["viscosity"])
                script = head(1e-4, boundary="f f f") + gravity() + couple(5) + thermo(5) + "run 100\n"
                spheres = [(diameter, density, (3e-3, 3.3e-3, 4.2e-3), (0, 0, 0))]
                rows, _ = self.run_scene(script, spheres, (0, 0, 0), (side,) * 3, case)
                found = rows[-1].velocity[2]
                if ratio == 1:
                    self.assertLess(abs(found), 1e-15)
                else:
                    self.assertAlmostEqual(found / terminal, 1, delta=1e-3)
                    for row in rows:
                        self.assertTrue(-0.01 <= row.velocity[2] / terminal <= 1.01)


class Suspension(HardCase):
    """Half of the volume is spheres, borne by the liquid: at rest in the mean, each with its slip."""

    NUMBER, DIAMETER = 8, 1e-3

    def test_hydrostatic_suspension(self):
        spacing = self.DIAMETER * (math.pi / 6 / 0.4) ** (1 / 3)
        side = self.NUMBER * spacing
        void, mu, rho = 0.6, WATER["viscosity"], WATER["density"]
        for ratio in RATIOS:
            with self.subTest(ratio=ratio):
                density = ratio * rho
                # The dynamic pressure: with -rho g it bears the mixture.
                gradient = -(1 - void) * (density - rho) * GRAVITY
                case = box((side,) * 3, (4, 4, 4), WATER)
                case = case.replace("[fluid]", f"[fluid]\ndriving_pressure_gradient = [0, 0, {gradient!r}]")
                script = head(1e-4, kn=100, gn=1e-3, skin=2e-4) + gravity() + couple(5) + thermo(25) + dump(25)
                spheres = lattice((self.NUMBER,) * 3, spacing, self.DIAMETER, density)
                rows, _ = self.run_scene(script + "run 2000\n", spheres, (0, 0, 0), (side,) * 3, case)
                expected = self.slip(density, void)
                fluid = void * rho * side**3
                slips = [row.gas[24] / fluid - row.velocity[2] for row in rows]
                self.assertAlmostEqual(slips[-1], expected, delta=1e-6 * abs(expected))
                for slip in slips:
                    self.assertTrue(-1e-9 <= slip * expected <= 1.01 * expected**2)
                # No net force on the mixture: its momentum stays, but for what is on its way.
                together = [row.momentum[2] + row.gas[24] for row in rows[-20:]]
                self.assertLessEqual(max(together) - min(together), 1e-10 * abs(expected) * fluid)
                # Nothing grows from particle to particle.
                speeds = [row[5] for row in self.spheres_now().values()]
                self.assertLessEqual(max(speeds) - min(speeds), 1e-9 * abs(expected))

    def test_too_light_for_model_a_is_told_before_the_run(self):
        """The limit is (1 - eps)/(2 eps) = 1/3 here."""
        spacing = self.DIAMETER * (math.pi / 6 / 0.4) ** (1 / 3)
        side = self.NUMBER * spacing
        warning = "WARNING: density ratio / ((1-eps) / (2 eps)) is {}, its least 1: [coupling] model = \"b\""
        for ratio, model, number in ((0.3, "a", "0.9"), (0.5, "a", None), (0.3, "b", None)):
            with self.subTest(ratio=ratio, model=model):
                case = box((side,) * 3, (4, 4, 4), WATER, {}, f'[coupling]\nmodel = "{model}"\n')
                spheres = lattice((self.NUMBER,) * 3, spacing, self.DIAMETER, ratio * WATER["density"])
                script = head(1e-4, kn=100, gn=1e-3, skin=2e-4) + couple(5) + thermo(1) + "run 0\n"
                code, output = self.start_scene(script, spheres, (0, 0, 0), (side,) * 3, case)
                self.assertEqual(code, 0, output)
                if number:
                    self.assertIn(warning.format(number), output)
                else:
                    self.assertNotIn("WARNING: density ratio", output)
                    self.assertIn("density ratio / ((1-eps) / (2 eps))", output)

    def slip(self, density, void):
        """beta s / (1 - eps) = (rho_p - rho) g eps with Ergun's beta [m/s]."""
        d, mu, rho = self.DIAMETER, WATER["viscosity"], WATER["density"]
        linear = 150 * (1 - void) * mu / (void * d**2)
        quadratic = 1.75 * rho / d
        push = abs(density - rho) * GRAVITY * void
        size = 2 * push / (linear + math.sqrt(linear**2 + 4 * quadratic * push))
        return math.copysign(size, density - rho)


if __name__ == "__main__":
    unittest.main()
