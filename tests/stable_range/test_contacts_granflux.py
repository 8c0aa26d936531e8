# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Contacts of LIGGGHTS last as long as the stable range says, for every normal law."""

import math
import unittest

from collision import DIAMETER, MASS, SPEED, check, told
from host import HostTest

REDUCED_MASS, REDUCED_RADIUS = MASS / 2, DIAMETER / 4
YOUNG, POISSON, CHARACTERISTIC = 5e6, 0.3, 0.5
EFFECTIVE = YOUNG / (2 * (1 - POISSON**2))  # modulus of two alike

STIFFNESS = """fix kn all property/global kn peratomtypepair 1 {kn}
fix kt all property/global kt peratomtypepair 1 0
fix gn all property/global gamman peratomtypepair 1 {gamma}
fix gt all property/global gammat peratomtypepair 1 0
pair_style gran model {law}
pair_coeff * *
"""
MODULUS = f"""fix Y all property/global youngsModulus peratomtype {YOUNG}
fix nu all property/global poissonsRatio peratomtype {POISSON}
fix e all property/global coefficientRestitution peratomtypepair 1 {{restitution}}
fix v all property/global characteristicVelocity scalar {CHARACTERISTIC}
pair_style gran model {{law}}
pair_coeff * *
"""


def hertz_time(modulus):
    return 2.868 * (REDUCED_MASS**2 / (REDUCED_RADIUS * modulus**2 * SPEED)) ** 0.2


class Contacts(HostTest):
    def lasts(self, contacts, expected):
        return check(self, self.run_script, contacts, expected)

    def as_told(self, contacts, expected):
        output, lasted, step = self.lasts(contacts, expected)
        self.assertLess(abs(told(output, step) / lasted - 1), 6e-3)  # three digits
        return output

    def test_linear_spring(self):
        time = math.pi * math.sqrt(REDUCED_MASS / 500)
        self.as_told(STIFFNESS.format(kn=500, gamma=0, law="hooke/stiffness"), time)

    def test_linear_spring_by_modulus(self):
        stiffness = (
            16 / 15 * math.sqrt(REDUCED_RADIUS) * EFFECTIVE
            * (15 * REDUCED_MASS * CHARACTERISTIC**2 / (16 * math.sqrt(REDUCED_RADIUS) * EFFECTIVE)) ** 0.2
        )
        output = self.as_told(
            MODULUS.format(restitution=1, law="hooke"), math.pi * math.sqrt(REDUCED_MASS / stiffness)
        )
        shear = YOUNG / 2 / (1 + POISSON)
        rayleigh = math.pi * DIAMETER / 2 * math.sqrt(1000 / shear) / (0.1631 * POISSON + 0.8766)
        self.assertIn("DEM step / Rayleigh time of type 1", output)
        row = next(line for line in output.splitlines() if "Rayleigh" in line).split()
        step = math.pi * math.sqrt(REDUCED_MASS / stiffness) / 400
        self.assertLess(abs(float(row[8]) / (step / rayleigh) - 1), 6e-3)

    def test_damped_spring_lasts_longer(self):
        """By the restitution e that the dashpot gives; the table then tells the shorter time of the longest step."""
        log = math.log(0.5)
        undamped = math.pi * math.sqrt(REDUCED_MASS / 500)
        decay = -log / math.sqrt(math.pi**2 + log**2) * math.sqrt(500 / REDUCED_MASS)
        lasting = undamped * math.sqrt(1 + (log / math.pi) ** 2)
        output, lasted, step = self.lasts(
            STIFFNESS.format(kn=500, gamma=2 * decay, law="hooke/stiffness"), lasting
        )
        ratio = decay * math.sqrt(REDUCED_MASS / 500)
        self.assertLess(abs(told(output, step) / (undamped * (math.sqrt(1 + ratio**2) - ratio)) - 1), 6e-3)
        self.assertLess(told(output, step), lasted)

    def test_hertz(self):
        self.as_told(MODULUS.format(restitution=1, law="hertz"), hertz_time(EFFECTIVE))

    def test_hertz_by_stiffness(self):
        self.as_told(STIFFNESS.format(kn=4e6, gamma=0, law="hertz/stiffness"), hertz_time(3e6))


if __name__ == "__main__":
    unittest.main()
