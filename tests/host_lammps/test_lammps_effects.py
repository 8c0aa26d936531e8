# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The keyword `effects` under LAMMPS: decisions as under LIGGGHTS, the same bits as by hand, what is off."""

import re
import unittest

from host import CASE, couple
from test_lammps_heat import HEAT, PROPERTIES, WARM_CASE
from two_hosts import TwoHostTest, dump, lammps_bed, liggghts_bed


def rows(output):
    """{effect: (value, state)} of the tables in an output."""
    found = {}
    for line in output.splitlines():
        row = re.match(r"  (\w[\w ]*?)\s{2,}\S.*?\s(\S+)\s+\S+  (on|off, no data|off|not modelled) ", line)
        if row:
            found[row[1]] = (row[2], row[3])
    return found


class Effects(TwoHostTest):
    def lammps(self, words, name="d", heat="", steps=40):
        return self.run_lammps(lammps_bed() + heat + couple(10, words) + dump(name, steps) + f"run {steps}\n")

    def test_auto_decides_as_under_liggghts(self):
        self.write("case.toml", WARM_CASE)
        heat = HEAT.format(words="effects auto")
        by_lammps = rows(self.lammps("effects auto", heat=heat))
        self.assertEqual(by_lammps["gas"][1], "on")
        self.assertEqual(by_lammps["convection"][1], "on")
        self.assertEqual(by_lammps["added mass"][1], "not modelled")
        script = liggghts_bed() + PROPERTIES.format(words="effects auto") + couple(10, "effects auto") + "run 10\n"
        by_liggghts = rows(self.run_script(script))
        self.assertEqual({e: v for e, (v, _) in by_lammps.items()}, {e: v for e, (v, _) in by_liggghts.items()})
        differ = {e for e in by_lammps if by_lammps[e] != by_liggghts[e]}
        self.assertEqual(differ, {"friction", "damping"})  # LAMMPS does not hand on what they are made of
        self.assertEqual({by_lammps[e][1] for e in differ}, {"off, no data"})

    def test_auto_has_the_bits_of_the_same_by_hand(self):
        self.lammps("effects auto")
        automatic = self.read("d")
        self.lammps("effects gas drag pressure_gradient two_way", name="h")
        self.assertEqual(automatic, self.read("h"))
        self.lammps("", name="n")
        self.assertEqual(automatic, self.read("n"))
        self.lammps("effects gas drag two_way", name="p")
        self.assertNotEqual(automatic, self.read("p"))

    def test_none_is_plain_particles(self):
        self.write("case.toml", WARM_CASE + '[output]\nfields = "gas"\nevery = 1e-4\n')
        output = self.lammps("effects none", heat=HEAT.format(words="effects none"))
        self.assertIn("the gas was not solved", output)
        self.assertEqual([p.name for p in self.folder.glob("gas*")], [])
        none = self.read("d")
        self.run_lammps(lammps_bed() + dump("p", 40) + "run 40\n")
        self.assertEqual(none, self.read("p"))

    def test_a_warning_where_what_is_off_comes_to_count(self):
        self.write("case.toml", CASE.replace("0, 0, 0.5", "0, 0, 0"))
        still = lammps_bed() + "velocity all set 0 0 0\n" + couple(10, "effects auto")
        before, after = self.run_lammps(still + "run 10\nvelocity all set 3 0 0\nrun 10\n").split("the gas was not solved", 1)
        self.assertNotIn("now counts", before)
        self.assertEqual(after.count("WARNING: the effect drag, which is off, now counts"), 1, after)

    def test_bad_words(self):
        for words, complaint in (("effects wind", "effects wind: unknown"), ("effects drag", "needs the effect gas")):
            with self.subTest(words=words):
                code, output = self.start_lammps(lammps_bed() + couple(10, words) + "run 1\n")
                self.assertNotEqual(code, 0, output)
                self.assertIn(complaint, output)


if __name__ == "__main__":
    unittest.main()
