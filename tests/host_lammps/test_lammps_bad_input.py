# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Wrong input stops before the first step on all ranks: a message with what, where and what is
allowed; exit code not 0; no hang. Texts are those of the fix in LIGGGHTS."""

import unittest

from host import CASE, couple
from two_hosts import TwoHostTest, lammps_bed, thermo

RUN = thermo() + "run 20\n"
BOTH = (1, 2)  # ranks: once for each place that finds faults; an end on two ranks takes mpirun seconds


class BadInput(TwoHostTest):
    def refused(self, script, *messages, before_first_step=True, ranks=(1,)):
        for count in ranks:
            with self.subTest(ranks=count, messages=messages):
                code, output = self.start_lammps(script, count)
                self.assertNotIn(code, (0, 124), output)
                for message in ("ERROR", *messages):
                    self.assertIn(message, output)
                if before_first_step:
                    self.assertNotIn("\n       0 ", output)  # no line of thermo output

    def case_refused(self, case, *messages):
        self.write("case.toml", case)
        self.refused(lammps_bed() + couple() + RUN, *messages)

    def test_words_of_the_fix(self):
        bed = lammps_bed()
        self.refused(bed + couple(more="couple_evry 5") + RUN, "couple_evry", "couple_every?", ranks=BOTH)
        self.refused(bed + couple(0) + RUN, "couple_every 0", "1 or more")
        self.refused(bed + couple(more="progress") + RUN, "progress has no value")
        self.refused(
            bed + couple(more="fixed_group walls") + RUN, "fixed_group walls: no such group"
        )
        self.refused(
            bed + "fix gas all granflux/couple couple_every 5\n" + RUN, "case is missing"
        )

    def test_missing_file(self):
        self.refused(
            lammps_bed() + couple().replace("case.toml", "nowhere.toml") + RUN, "nowhere.toml"
        )

    def test_case(self):
        self.case_refused(CASE.replace("density", "densty = 1\ndensity"), "case.toml", "densty")
        self.case_refused(CASE.replace("density = 1.2", "density = -1.2"), "density", "-1.2")

    def test_box_that_does_not_match(self):
        self.case_refused(
            CASE.replace("[10e-3, 6e-3, 40e-3]", "[10e-3, 6e-3, 50e-3]"), "high side in z", "0.05", "0.04"
        )

    def test_particle_outside_the_grid(self):
        self.write("case.toml", CASE.replace("[10e-3, 6e-3, 40e-3]", "[10e-3, 6e-3, 3e-3]"))
        self.refused(
            lammps_bed() + couple(more="box any") + RUN, "particle", "outside the gas grid", ranks=BOTH
        )

    def test_gravity_that_does_not_match(self):
        self.case_refused(
            CASE.replace("viscosity", "gravity = [0, 0, -9.8]\nviscosity"), "9.81", "-9.8"
        )

    def test_scripts_that_cannot_be_coupled(self):
        bed = lammps_bed()
        self.refused(
            bed.replace("units           si", "units           cgs") + couple() + RUN, "units cgs", "si"
        )
        self.refused(bed + couple() + couple().replace("gas", "air") + RUN, "gas", "one gas only")
        self.refused(bed + couple() + "minimize 0 1e-4 10 10\n", "minimize")
        self.refused(
            bed.replace("fix             move all nve/sphere", "fix move all rigid single")
            + couple() + RUN,
            "fix move (style rigid): rigid bodies",
        )

    def test_time_step_changed_within_a_run(self):
        script = lammps_bed() + "fix dt all dt/reset 5 1e-9 1e-4 1e-6 units box\n" + couple() + RUN
        self.refused(script, "the time step changed", before_first_step=False, ranks=BOTH)

    def test_unknown_word_of_fix_modify(self):
        self.refused(
            lammps_bed() + couple() + "fix_modify gas speed 3\n" + RUN, "Illegal fix_modify"
        )


if __name__ == "__main__":
    unittest.main()
