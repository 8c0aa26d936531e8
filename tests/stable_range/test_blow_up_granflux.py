# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs that leave their stable range: what is said before, and how they end on one rank and two."""

import time
import unittest

from host import CASE, GRANFLUX, HostTest, bed, bed_from, couple, thermo, thermo_rows

STEP = "timestep        1e-5"
LONGEST = 60  # s from start to end of a run that fails, on a machine full of others


def bed_with(step):
    script = bed()
    assert STEP in script
    return script.replace(STEP, f"timestep {step}")


class BlowUp(HostTest):
    def fails(self, script, *messages, ranks=(1, 2), program=GRANFLUX):
        for count in ranks:
            with self.subTest(ranks=count):
                start = time.monotonic()
                code, output = self.start(script, count, program)
                self.assertNotIn(code, (0, 124), output)
                self.assertLess(time.monotonic() - start, LONGEST)
                self.assertEqual(output.count("ERROR: fix gas granflux/couple"), 1, output)
                error = next(line for line in output.splitlines() if "ERROR: fix gas" in line)
                for message in messages:
                    self.assertIn(message, error)
        return output

    def case(self, old, new):
        self.assertIn(old, CASE)
        self.write("case.toml", CASE.replace(old, new))

    def test_table_and_warning_come_first(self):
        output = self.run_script(bed_with("5e-6") + couple() + thermo() + "run 20\nrun 10\n")
        self.assertEqual(output.count("granflux: stable range"), 2)  # of each run
        for row in (
            "DEM step / contact time of types 1-1",
            "path in a DEM step / radius",
            "gas Courant number",
            "gas friction number",
            "coupling interval / response time",
            "smallest cell / largest diameter",
            "least void fraction of a cell",
        ):
            self.assertIn(row, output)
        self.assertNotIn("granflux: WARNING", output)
        output = self.run_script(bed() + couple() + thermo() + "run 20\n")
        warning = "WARNING: DEM step / contact time of types 1-1 is 0.152, its limit 0.1: timestep up to 6.59e-06"
        self.assertEqual(output.count(warning), 1)
        self.assertLess(output.index(warning), output.index("\n       0 "))

    def test_time_step_too_long(self):
        cause = "likely cause: DEM step / contact time of types 1-1 is "
        # At once, and after the energy has grown for a while.
        self.fails(
            bed_with("3e-4") + couple() + thermo() + "run 2000\n",
            "step 0: particle ", " of its radius in one step; " + cause + "4.55", "timestep up to 6.59e-06",
        )
        self.fails(
            bed_with("4e-5") + couple() + thermo() + "run 2000\n",
            ": particle ", " of its radius in one step; " + cause + "0.607", ranks=(1,),
        )

    def test_gas_absurdly_quick(self):
        self.case("[0, 0, 0.5]", "[0, 0, 3e4]")
        self.fails(
            bed_with("5e-6") + couple() + thermo() + "run 200\n",
            "gas: step 1, ", "Courant number ", " in cell (", " m/s",
            "likely cause: gas Courant number is 750, its limit 0.5: timestep up to 3.33e-08 with couple_every 1",
        )

    def test_gas_that_becomes_too_quick(self):
        """Said when the number crosses its limit, long before the end."""
        self.case("[0, 0, 0.5]", "[0, 0, 0.5]\nramp_time = 1e-4\nramp_from = 0.01")
        self.write("case.toml", self.read("case.toml").replace("0.5]", "200]"))
        output = self.fails(
            bed_with("5e-6") + couple() + thermo() + "run 2000\n",
            "gas: step ", " in cell (", "likely cause: gas Courant number is", ranks=(1,),
        )
        warning = output.index("WARNING: gas Courant number is")
        self.assertLess(warning, output.index("ERROR: fix gas"))

    def test_cells_too_small(self):
        self.case("[5, 3, 20]", "[20, 12, 80]")
        self.fails(
            bed_with("5e-6") + couple() + thermo() + "run 20\n",
            "void fraction -2.39", " in cell (", "centre (",
            "likely cause: smallest cell / largest diameter is 0.5, its least 1: [grid] cells of at least 0.001 m",
        )

    def test_particle_that_is_not_a_number(self):
        script = (
            bed_with("5e-6") + "group one id 57\n" + couple() + thermo()
            + "run 50\nvariable bad equal exp(1000)-exp(1000)\nvelocity one set v_bad NULL NULL\nrun 50\n"
        )
        self.fails(
            script, "step 50: particle 57 at (", "not a number",
            "no number of the stable range was beyond its limit: look at forces, velocities and temperatures",
            "no state was kept: fix granflux/checkpoint keeps them",
        )

    def test_last_good_state_is_named_and_kept(self):
        keep = "fix keep all granflux/checkpoint kept every 20\n"
        script = (
            bed_with("5e-6") + "group one id 57\n" + couple() + keep + thermo()
            + "run 50\nvariable bad equal exp(1000)-exp(1000)\nvelocity one set v_bad NULL NULL\nrun 50\n"
        )
        self.fails(script, "last good state: checkpoint kept of step 40", ranks=(1,))
        again = bed_from("kept").replace(STEP, "timestep 5e-6") + couple() + thermo() + "run 40\n"
        output = self.run_script(again)
        self.assertIn("granflux: stable range", output)
        self.assertEqual(thermo_rows(output)[-1][0], 80)

    def test_runs_of_particles_alone(self):
        """Said once, where the time step is too long; the steps themselves are as they were."""
        output = self.run_script(bed() + "run 10\nrun 10\n")
        self.assertEqual(output.count("granflux: stable range"), 1)
        self.assertIn("0.152        0.1  BEYOND  timestep up to 6.59e-06", output)


if __name__ == "__main__":
    unittest.main()
