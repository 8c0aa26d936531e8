# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""[coupling] drag_treatment and coarse_graining in whole runs of the program that PROGRAM names, granflux or granflux_lammps.

A sphere in a stream that does not feel it (one way, Stokes' drag) takes up its velocity: v = u (1 - exp(-t/tau)), and
by explicit steps dt = c tau, of which the host halves the first and the last, v = u (1 - (1 - c/2)^2 (1 - c)^(n-1)).
"""

import math
import os
import re
import unittest

from few_spheres import script
from host import CASE, HostTest

LAMMPS = os.environ["PROGRAM"] == "granflux_lammps"
PROGRAM = os.environ["GRANFLUX_LAMMPS" if LAMMPS else "GRANFLUX"]

DIAMETER, DENSITY, VISCOSITY, SPEED = 1e-4, 1000.0, 1.8e-5, 1e-4
TAU = DENSITY * DIAMETER**2 / (18 * VISCOSITY)  # s

MORE = """
fix             gas all granflux/couple case case.toml couple_every {every} effects {effects}
variable        speed equal vz[1]
thermo_style    custom step v_speed
thermo_modify   lost error norm no format float %.15g"""
# So soft that nothing need be resolved.
CONTACTS = (
    "pair_style gran/hooke/history 1e-12 3e-13 0 0 0 0\npair_coeff * *" if LAMMPS else "".join(
        f"fix {name} all property/global {what} peratomtypepair 1 {value}\n"
        for name, what, value in (("kn", "kn", 1e-12), ("kt", "kt", 3e-13), ("gn", "gamman_abs", 0), ("gt", "gammat_abs", 0),
                                  ("mu", "coefficientFriction", 0)))
    + "pair_style gran model hooke/stiffness tangential history absolute_damping on\npair_coeff * *")


def slip_by_steps(c, steps):
    return (1 - c / 2) ** 2 * (1 - c) ** (steps - 1)


class DragTreatment(HostTest):
    def run_sphere(self, coupling, dt, steps, every=1, diameter=DIAMETER, effects="gas drag"):
        slip_sides = CASE.replace('"wall"', '"slip"').replace("0, 0, 0.5", f"0, 0, {SPEED}")
        self.write("case.toml", slip_sides + f"[initial]\nvelocity = [0, 0, {SPEED}]\n"
                   + f'[coupling]\ndrag = "stokes"\n{coupling}\n')
        text = script(LAMMPS, (5e-3,), diameter, DENSITY, CONTACTS, skin=1e-3, step=dt, steps=steps, every=steps,
                      more=MORE.format(every=every, effects=effects))
        self.output = self.run_script(text, program=PROGRAM)
        found = re.findall(rf"^ +{steps} +([-+.\de]+)", self.output, re.MULTILINE)
        return 1 - float(found[-1]) / SPEED  # slip over that of the start

    def test_forms(self):
        for treatment in ("explicit", "semi_implicit"):
            for c in (0.05, 0.5, 1.5):
                with self.subTest(treatment=treatment, step=c):
                    slip = self.run_sphere(f'drag_treatment = "{treatment}"', c * TAU, 8, every=4)
                    self.assertAlmostEqual(slip, slip_by_steps(c, 8), delta=1e-9)
        for c in (0.05, 0.5, 1.5, 20):
            slip = self.run_sphere('drag_treatment = "implicit"', c * TAU, 8, every=4)
            # The host halves the first and the last step here, too.
            mean = -math.expm1(-c) / c
            self.assertAlmostEqual(slip, (1 - c * mean / 2) ** 2 * math.exp(-7 * c), delta=1e-9)

    def test_limit_is_two_response_times(self):
        treatment = 'drag_treatment = "semi_implicit"'
        self.assertLess(abs(self.run_sphere(treatment, 1.9 * TAU, 40)), 0.02)
        self.assertNotIn("WARNING: DEM step / response time", self.output)
        self.assertRegex(self.output, r"DEM step / response time +1\.9 +2 +CLOSE")
        self.assertGreater(abs(self.run_sphere(treatment, 2.2 * TAU, 40)), 10)
        warning = r'WARNING: DEM step / response time is 2\.2, its limit 2: timestep up to 0.0617.* drag_treatment = "implicit"'
        self.assertRegex(self.output, warning)
        # Of the default, which bears any step, the row is another.
        self.assertLess(abs(self.run_sphere("", 2.2 * TAU, 20)), 0.1)
        self.assertNotIn("DEM step / response time", self.output)

    def test_explicit_gas_has_a_limit_of_its_own(self):
        treatment = 'drag_treatment = "explicit"'
        self.run_sphere(treatment, 0.1 * TAU, 4, effects="gas drag two_way")
        self.assertIn("coupling interval x decay rate of the slip", self.output)
        self.run_sphere(treatment, 1.2 * TAU, 4, every=2, effects="gas drag two_way")
        self.assertRegex(self.output, r"WARNING: coupling interval x decay rate of the slip is 2\.4\d*, its limit 2: couple_every up to 1")

    def test_parcels_respond_as_their_particles(self):
        one = self.run_sphere("", 0.1 * TAU, 5)
        parcel = self.run_sphere("coarse_graining = 3", 0.1 * TAU, 5, diameter=3 * DIAMETER)
        self.assertAlmostEqual(parcel, one, delta=1e-12)
        self.assertIn("each particle is a parcel of 27 particles", self.output)

    def test_bad_values(self):
        for key, texts in (('drag_treatment = "exact"', ("drag_treatment", "explicit", "semi_implicit", "implicit")),
                           ("coarse_graining = 0.5", ("coarse_graining", "0.5"))):
            with self.assertRaises(AssertionError) as failed:
                self.run_sphere(key, 1e-4, 1)
            for text in texts:
                self.assertIn(text, str(failed.exception))


if __name__ == "__main__":
    unittest.main()
