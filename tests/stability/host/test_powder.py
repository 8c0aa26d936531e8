# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A bed of fine powder with steps twenty times longer than an explicit drag could take."""

import math
import unittest

from host import couple
from scenes import AIR, GRAVITY, HardCase, box, gravity, head, lattice, thermo, volume, walls

DIAMETER, DENSITY = 75e-6, 1500.0
ACROSS, LAYERS = 6, 24
CELL, SIDE, BED = 3 * DIAMETER, ACROSS * DIAMETER, LAYERS * DIAMETER
SIDES = {"z_low": 'type = "inlet"\nvelocity = [0, 0, {}]', "z_high": 'type = "outlet"'}
DT, EVERY, STIFFNESS = 1e-6, 100, 1.0
VOID = 1 - math.pi / 6
WEIGHT = BED * (1 - VOID) * (DENSITY - AIR["density"]) * GRAVITY  # over area [Pa]


def gidaspow(void, velocity):
    """Pressure gradient of a packed bed at a superficial velocity, Ergun's law [Pa/m]."""
    mu, rho = AIR["viscosity"], AIR["density"]
    return 150 * (1 - void) ** 2 * mu * velocity / (void**3 * DIAMETER**2) + 1.75 * (
        1 - void
    ) * rho * velocity**2 / (void**3 * DIAMETER)


class Powder(HardCase):
    """864 spheres of 75 um, simple cubic between a floor and the free surface, open to gas from below."""

    def bed(self, velocity, steps, height, carried, every=EVERY):
        """carried: share of the weight that the gas bears; springs bear the rest from the start."""
        sides = {name: text.format(velocity) for name, text in SIDES.items()}
        low, high = (0, 0, 0), (SIDE, SIDE, height)
        case = box(high, (2, 2, round(height / CELL)), AIR, sides)
        each = (1 - carried) * volume(DIAMETER) * DENSITY * GRAVITY / STIFFNESS
        spheres = []
        for n, (d, density, (x, y, z), v) in enumerate(
            lattice((ACROSS, ACROSS, LAYERS), DIAMETER, DIAMETER, DENSITY)
        ):
            below = n // ACROSS**2  # layers
            sunk = sum(LAYERS - k for k in range(below + 1)) * each
            spheres.append((d, density, (x, y, z - sunk), v))
        script = (
            head(DT, boundary="p p f", kn=STIFFNESS, gn=1e-5, skin=2e-5)
            + walls(["zplane 0"])
            + gravity()
            + couple(every)
            + thermo(every)
        )
        return self.run_scene(script + f"run {steps}\n", spheres, low, high, case)[0]

    def explicit_limit(self, velocity):
        """Longest step of an explicit drag: 2 over the rates of gas and particles together."""
        beta = gidaspow(VOID, velocity) / velocity * VOID**2  # kg/(m3 s), of the interstitial slip
        return 2 / (beta / (VOID * AIR["density"]) + beta / ((1 - VOID) * DENSITY))

    def test_pressure_drop_is_that_of_ergun(self):
        velocity = 2e-3
        self.assertGreater(DT * EVERY, 20 * self.explicit_limit(velocity))
        expected = gidaspow(VOID, velocity) * BED
        rows = self.bed(velocity, 2000, BED, expected / WEIGHT)
        print(f"limit {DT * EVERY/self.explicit_limit(velocity)} share {expected/WEIGHT} pressure drop over Ergun's", *(f"{row.gas[1] / expected:.4f}" for row in rows))
        for row in rows[1:]:
            self.assertAlmostEqual(row.gas[1] / expected, 1, delta=0.02)

    def test_sudden_inlet_carries_the_weight(self):
        """The whole velocity at once, above that of minimum fluidization: the plug is lifted, and the
        pressure drop is its weight and no more than what gives it its acceleration."""
        rows = self.bed(8e-3, 3000, 2 * BED, 0)
        print("pressure drop over weight", *(f"{row.gas[1] / WEIGHT:.3f}" for row in rows[::3]))
        for row in rows[1:]:
            self.assertTrue(0 < row.gas[1] < 3 * WEIGHT)
        self.assertAlmostEqual(rows[-1].gas[1] / WEIGHT, 1, delta=0.02)


if __name__ == "__main__":
    unittest.main()
