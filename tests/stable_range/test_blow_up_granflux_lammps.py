# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""As test_blow_up_granflux.py, beside LAMMPS' particles: the same numbers, the same errors."""

import unittest

from host import CASE, couple
from two_hosts import TIME_STEP, TwoHostTest, lammps_bed, thermo


def bed_with(step):
    script = lammps_bed()
    assert f"timestep        {TIME_STEP}" in script
    return script.replace(f"timestep        {TIME_STEP}", f"timestep {step}")


class BlowUp(TwoHostTest):
    def fails(self, script, *messages, ranks=(1, 2)):
        for count in ranks:
            with self.subTest(ranks=count):
                code, output = self.start_lammps(script, count)
                self.assertNotIn(code, (0, 124), output)
                errors = [line for line in output.splitlines() if line.startswith("ERROR: fix gas")]
                self.assertTrue(errors, output)
                for message in messages:
                    self.assertIn(message, errors[0])

    def test_time_step_too_long(self):
        self.fails(
            bed_with(3e-4) + couple() + thermo() + "run 2000\n",
            "step 0: particle ", " of its radius in one step; likely cause: DEM step / contact time of types 1-1 is ",
        )

    def test_cells_too_small(self):
        self.write("case.toml", CASE.replace("[5, 3, 20]", "[20, 12, 80]"))
        self.fails(
            bed_with(5e-6) + couple() + thermo() + "run 20\n",
            "likely cause: smallest cell / largest diameter is 0.5, its least 1", ranks=(1,),
        )

    def test_particle_that_is_not_a_number(self):
        self.fails(
            bed_with(5e-6) + "group one id 57\n" + couple() + thermo()
            + "run 50\nvariable bad equal exp(1000)-exp(1000)\nvelocity one set v_bad NULL NULL\nrun 50\n",
            "step 50: particle 57 at (", "not a number", "no number of the stable range",
        )


if __name__ == "__main__":
    unittest.main()
