# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Temperatures beside LIGGGHTS' own fix heat/gran/conduction, in its convention of the contact area."""

import pathlib
import re
import unittest

from host import LIGGGHTS, HostTest, last_snapshot
from packed_box import data_file, script

TUTORIALS = pathlib.Path("/usr/share/doc/liggghts/examples/LIGGGHTS/Tutorials_public")
OWN = "granflux/heat initial_temperature 300. conduction stock friction off"
DUMP = 'dump t all custom {steps} temperatures id f_Temp f_heatFlux\ndump_modify t sort id format "%d %.17g %.17g"\n'

PROPERTIES = """
fix             tk all property/global thermalConductivity peratomtype 100 40
fix             tc all property/global thermalCapacity peratomtype 1 2
{original}
fix             heat all {heat}
{walls}
run             0
group           hot id <= 60
set             group hot property/atom Temp 800
group           source id 70
set             group source property/atom heatSource 1e-3
"""



def largest_difference(a, b):
    """Of temperatures relative to their spread, of heat relative to the largest."""
    assert a.keys() == b.keys()
    spread = max(row[0] for row in a.values()) - min(row[0] for row in a.values())
    most = max(abs(row[1]) for row in a.values())
    return max(
        max(abs(a[i][0] - b[i][0]) / spread for i in a), max(abs(a[i][1] - b[i][1]) / most for i in a)
    )


@unittest.skipUnless(LIGGGHTS, "liggghts is not installed")
class BesideStock(HostTest):
    def box_script(self, heat, model, original=""):
        cells, spacing = (5, 5, 5), 0.93
        self.write("data.box", data_file(cells, spacing, 0.5, 100, 0))
        top = cells[2] * spacing * 2e-3
        walls = (
            f"fix low all wall/gran model {model} primitive type 1 zplane 0 temperature 500\n"
            f"fix high all wall/gran model {model} primitive type 2 zplane {top} temperature 350\n"
        )
        more = PROPERTIES.format(heat=heat, walls=walls, original=original)
        text = script("forces", "model " + model, boundary="p p f", more=more, runs=(), step=1e-6)
        return text + DUMP.format(steps=100) + "run 100\n"

    def compare(self, model, original="", words="", **run):
        self.run_script(self.box_script("heat/gran/conduction initial_temperature 300. " + words, model, original), program=LIGGGHTS)
        stock = last_snapshot(self.read("temperatures"))
        self.run_script(self.box_script(OWN, model, original), **run)
        own = last_snapshot(self.read("temperatures"))
        self.assertLess(largest_difference(stock, own), 1e-10)
        self.assertGreater(largest_difference(stock, {i: [row[0] * 1.05, row[1]] for i, row in own.items()}), 1e-3)

    def test_fused(self):
        for model in ("hertz tangential history", "hooke/stiffness tangential history"):
            for threads in ("1", "2"):
                with self.subTest(model=model, threads=threads):
                    self.compare(model, options=("-threads", threads))

    def test_fused_on_two_ranks(self):
        self.compare("hertz tangential history", ranks=2)

    def test_with_the_true_modulus(self):
        self.compare(
            "hertz tangential history",
            "fix yo all property/global youngsModulusOriginal peratomtype 5e9 8e8",
            "contact_area overlap area_correction yes",
        )

    def test_laws_without_a_form_by_subset(self):
        self.compare(
            "hertz tangential history rolling_friction epsd",
            "fix rv all property/global coefficientRollingViscousDamping peratomtypepair 2 0.1 0.1 0.1 0.1",
        )

    def tutorial(self, name, heat):
        text = (TUTORIALS / name / "in.heatGran").read_text()
        text, changed = re.subn(r"(fix\s+heattransfer\s+all\s+).*", lambda m: m[1] + heat, text)
        self.assertEqual(changed, 1)
        text = re.sub(r"dump\s+dmp .*", "", text)
        for old, new in (("50000", "8500"), ("20000", "8000"), ("10000", "500")):
            text = text.replace(old + " upto", new + " upto")
        return text.replace("run\t8500", "run 8500").rstrip().rsplit("\n", 1)[0] + "\n" + DUMP.format(steps=8500) + "run 8500 upto\n"

    def test_packaged_tutorials(self):
        # On the host's own forces, so that both see the same contacts to the last bit.
        for name in ("heatTransfer_1", "heatTransfer_2"):
            with self.subTest(name=name):
                self.run_script(self.tutorial(name, "heat/gran initial_temperature 300."), program=LIGGGHTS)
                stock = last_snapshot(self.read("temperatures"))
                self.run_script(self.tutorial(name, OWN), options=("-subset", "off"))
                own = last_snapshot(self.read("temperatures"))
                self.assertGreater(len(own), 500)
                self.assertLess(largest_difference(stock, own), 1e-10)


if __name__ == "__main__":
    unittest.main()
