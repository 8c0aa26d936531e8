# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Wrong input stops before the first step on all ranks: a message with what, where and what is
allowed; exit code not 0; no hang."""

import unittest

from host import CASE, HostTest, bed, couple, thermo

RUN = thermo() + "run 20\n"
BOTH = (1, 2)  # ranks: once for each place that finds faults; an end on two ranks takes mpirun seconds


class BadInput(HostTest):
    def refused(self, script, *messages, before_first_step=True, ranks=(1,)):
        for count in ranks:
            with self.subTest(ranks=count, messages=messages):
                code, output = self.start(script, count)
                self.assertNotIn(code, (0, 124), output)
                for message in ("ERROR", *messages):
                    self.assertIn(message, output)
                if before_first_step:
                    self.assertNotIn("\n       0 ", output)  # no line of thermo output

    def case_refused(self, case, *messages, ranks=(1,)):
        self.write("case.toml", case)
        self.refused(bed() + couple() + RUN, *messages, ranks=ranks)

    def test_unknown_keyword_of_the_fix(self):
        self.refused(bed() + couple(more="couple_evry 5") + RUN, "couple_evry", "couple_every?", ranks=BOTH)

    def test_bad_values_of_the_fix(self):
        self.refused(bed() + couple(0) + RUN, "couple_every 0", "1 or more")
        self.refused(bed() + couple("2.5") + RUN, "couple_every 2.5")
        self.refused(bed() + couple(more="progress nan") + RUN, "progress nan")
        self.refused(bed() + couple(more="box some") + RUN, "box some", "match or any")
        self.refused(bed() + couple(more="fixed_group walls") + RUN, "fixed_group walls")
        self.refused(bed() + couple(more="progress") + RUN, "progress has no value")

    def test_missing_keyword_of_the_fix(self):
        self.refused(bed() + "fix gas all granflux/couple couple_every 5\n" + RUN, "case is missing")

    def test_missing_file(self):
        script = bed() + couple().replace("case.toml", "nowhere.toml") + RUN
        self.refused(script, "nowhere.toml", ranks=BOTH)

    def test_unknown_key_of_the_case(self):
        self.case_refused(CASE.replace("density", "densty = 1\ndensity"), "case.toml", "densty", ranks=BOTH)

    def test_missing_key_of_the_case(self):
        self.case_refused(CASE.replace("density", "#"), "case.toml", "density", "is missing")

    def test_bad_values_of_the_case(self):
        self.case_refused(CASE.replace("density = 1.2", "density = -1.2"), "density", "-1.2")
        self.case_refused(CASE.replace("density = 1.2", "density = nan"), "density", "nan")
        self.case_refused(CASE + '[coupling]\ndrag = "stoks"\n', "stoks", "stokes")

    def test_shares_that_need_a_box(self):
        drum = '[grid]\nkind = "cylinder"\nradius = 1\nlength = 1\ncells = [2, 4, 2]\n'
        boundaries = ('[[boundary]]\nname = "wall"\ntype = "wall"\n[[boundary]]\nname = "low"\n'
                      'type = "wall"\n[[boundary]]\nname = "high"\ntype = "wall"\n')
        fluid = CASE[CASE.index("[fluid]") : CASE.index("[[boundary]]")]
        self.case_refused(drum + fluid + boundaries, 'void_fraction = "trilinear" needs a box grid')

    def test_overlapping_boundaries(self):
        self.case_refused(
            CASE + '[[boundary]]\nname = "hole"\nside = "z_low"\ntype = "wall"\n', "hole"
        )

    def test_box_that_does_not_match(self):
        self.case_refused(
            CASE.replace("[10e-3, 6e-3, 40e-3]", "[10e-3, 6e-3, 50e-3]"), "high side in z", "0.05", "0.04",
            ranks=BOTH,
        )
        self.refused(bed(boundary="f p f").replace("fix             ylow", "#").replace(
            "fix             yhigh", "#").replace(
            "                primitive type 1 yplane 0 absolute_damping on", "").replace(
            "                primitive type 1 yplane 6e-3 absolute_damping on", "") + couple() + RUN,
            "direction y is not periodic for the gas grid")

    def test_particle_outside_the_grid(self):
        self.write("case.toml", CASE.replace("[10e-3, 6e-3, 40e-3]", "[10e-3, 6e-3, 3e-3]"))
        self.refused(bed() + couple(more="box any") + RUN, "particle", "outside the gas grid", ranks=BOTH)

    def test_gravity_that_does_not_match(self):
        self.case_refused(
            CASE.replace("viscosity", "gravity = [0, 0, -9.8]\nviscosity"), "9.81", "-9.8"
        )

    def test_units(self):
        self.refused(
            "units cgs\natom_style granular\nboundary f f f\nnewton off\ncommunicate single vel yes\n"
            + "\n".join(bed().split("\n")[8:]) + couple() + RUN, "units cgs", "si")

    def test_second_fix(self):
        self.refused(bed() + couple() + couple().replace("gas", "air") + RUN, "gas", "one gas only")

    def test_time_step_changed_within_a_run(self):
        script = bed() + "fix dt all dt/reset 5 1e-9 1e-4 1e-6 units box\n" + couple() + RUN
        self.refused(script, "the time step changed", before_first_step=False, ranks=BOTH)

    def test_minimize(self):
        self.refused(bed() + couple() + "minimize 0 1e-4 10 10\n", "minimize")

    def test_unknown_word_of_fix_modify(self):
        self.refused(bed() + couple() + "fix_modify gas speed 3\n" + RUN, "Illegal fix_modify")


if __name__ == "__main__":
    unittest.main()
