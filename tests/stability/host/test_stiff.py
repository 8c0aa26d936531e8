# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Drag and heat far quicker than the steps, in whole runs."""

import math
import unittest

from host import couple, thermo_rows
from scenes import AIR, HardCase, box, data_file, dump, energy, head, heat, lattice, thermo, volume

DIAMETER, DENSITY, CAPACITY, GAS_CAPACITY = 20e-6, 1000.0, 1000.0, 1000.0
STOKES = 3 * math.pi * AIR["viscosity"] * DIAMETER  # kg/s
MASS = DENSITY * volume(DIAMETER)
RELAXATION = MASS / STOKES  # s; of the temperature nearly the same
SIDE, NUMBER = 0.8e-3, 8
LOW, HIGH = (0, 0, 0), (SIDE,) * 3
SPEED = (2e-6, -1e-6, 3e-6)  # m/s: less than a radius in the longest step
CASE = box(HIGH, (4, 4, 4), AIR)


def dust():
    """512 spheres of 20 um, four times as heavy as the gas around them."""
    return lattice((NUMBER,) * 3, SIDE / NUMBER, DIAMETER, DENSITY, SPEED)


class Dust(HardCase):
    """It drifts into gas at rest."""

    def drift(self, interval, every, hot, cold):
        """interval: of coupling, in relaxation times; temperatures of particles and gas at the start."""
        steps = max(4 * every, math.ceil(every * 60 / interval))
        script = (
            head(interval * RELAXATION / every)
            + heat(hot, CAPACITY)
            + couple(every)
            + thermo(every)
            + dump(every, "f_Temp f_gasTemperature")
        )
        rows, _ = self.run_scene(
            script + f"run {steps}\n",
            dust(),
            LOW,
            HIGH,
            CASE + energy(cold, GAS_CAPACITY),
        )
        return rows

    def test_equilibrium_from_a_tenth_to_a_thousand_relaxation_times(self):
        number = NUMBER**3
        gas_mass = AIR["density"] * (SIDE**3 - number * volume(DIAMETER))
        mass = number * MASS
        for every in (1, 100):
            for interval in (0.1, 1, 10, 1000):
                for hot, cold in ((300, 1300), (1300, 300)):
                    if interval == 0.1 and (every == 100 or hot == 1300):
                        continue  # the long ones, once
                    with self.subTest(every=every, interval=interval, hot=hot, cold=cold):
                        self.check_drift(self.drift(interval, every, hot, cold), mass, gas_mass, hot, cold)

    def check_drift(self, rows, mass, gas_mass, hot, cold):
        scale = mass * max(map(abs, SPEED))
        for d, speed in enumerate(SPEED):
            common = mass * speed / (mass + gas_mass)
            # What the gas is ahead by, particles receive by the end of an interval.
            after = [row.velocity[d] for row in rows]
            low, high = sorted((common, speed))
            slack = 1e-9 * abs(speed)
            for v, next_v in zip(after, after[1:]):
                self.assertTrue(low - slack <= next_v <= high + slack, (low, next_v, high))
                self.assertLessEqual(abs(next_v - common), abs(v - common) + slack)
            last = rows[-1]
            self.assertAlmostEqual((last.momentum[d] + last.gas[22 + d]) / scale, mass * speed / scale, delta=1e-12)
            self.assertAlmostEqual(after[-1] / common, 1, delta=1e-6)
        equilibrium = (mass * CAPACITY * hot + gas_mass * GAS_CAPACITY * cold) / (
            mass * CAPACITY + gas_mass * GAS_CAPACITY
        )
        low, high = sorted((hot, cold))
        for part in self.read("dump.spheres").split("ITEM: ATOMS")[2:]:
            for line in part.partition("ITEM: TIMESTEP")[0].splitlines()[1:]:
                for temperature in map(float, line.split()[-2:]):
                    self.assertTrue(low - 1e-9 <= temperature <= high + 1e-9, temperature)
        for temperatures in self.spheres_now().values():
            self.assertAlmostEqual(temperatures[-2], equilibrium, delta=1e-6 * equilibrium)
            self.assertAlmostEqual(temperatures[-1], equilibrium, delta=1e-6 * equilibrium)

    def test_an_explicit_drag_blows_up(self):
        """The drag of the stock program, fix viscous, with two and a half relaxation times a step."""
        self.write("data.spheres", data_file(dust(), LOW, HIGH))
        script = head(2.5 * RELAXATION) + f"fix naive all viscous {STOKES}\nthermo_style custom step ke\nrun {{}}\n"
        energies = [thermo_rows(self.run_script(script.format(steps)))[-1][1] for steps in (2, 12)]
        self.assertGreater(energies[1], 10 * energies[0])


if __name__ == "__main__":
    unittest.main()
