# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What else of the host looks at contacts: restarts, computes, heat, virial, insertion; changes of path."""

import unittest

from beside_stock import AFTER_100, BesideStock, dense, words
from host import GRANFLUX, LIGGGHTS, thermo_rows
from packed_box import data_file, difference, script, snapshots

MODEL = words("hertz", "tangential history", "", "rolling_friction epsd2")
BY_SUBSET = "contact forces by particle subset"


class HostParts(BesideStock):
    def setUp(self):
        super().setUp()
        self.write("data.box", dense(cells=5))

    def run_both(self, text, ranks=1, threads=2):
        """Output of the stock program and of ours; PROGRAM in the script is `stock` or `subset`."""
        stock = self.run_script(text.replace("PROGRAM", "stock"), ranks, LIGGGHTS)
        ours = self.run_script(text.replace("PROGRAM", "subset"), ranks, GRANFLUX, ("-threads", str(threads)))
        return stock, ours

    def compare_dumps(self, limit=AFTER_100):
        stock, ours = (snapshots(self.read(f"{name}.txt")) for name in ("stock", "subset"))
        self.assertEqual(stock.keys(), ours.keys())
        for step in stock:
            for name, value in difference(stock[step], ours[step]).items():
                self.assertLess(value, limit, f"{name} at step {step}")

    def compare_rows(self, stock, ours, limit):
        self.assertEqual(len(stock), len(ours))
        self.assertGreater(len(stock), 0)
        for column in range(len(stock[0])):
            scale = max(abs(row[column]) for row in stock) or 1.0
            worst = max(abs(a[column] - b[column]) for a, b in zip(stock, ours)) / scale
            self.assertLess(worst, limit, f"column {column}")

    def test_same_bits_on_any_number_of_threads(self):
        dumps = []
        for threads in (1, 2, 3, 5):
            text = script(f"dump.{threads}", MODEL, sort="sort 10 0.0", step=5e-6, runs=(150,))
            self.run_script(text, 1, GRANFLUX, ("-threads", str(threads)))
            dumps.append(self.read(f"dump.{threads}"))
        for dump in dumps[1:]:
            self.assertTrue(dump == dumps[0])

    def test_restart(self):
        """Each program goes on from the file of the other as the stock program does from its own."""
        first = script("first.txt", MODEL, runs=(60,)) + "write_restart PROGRAM.restart\n"
        self.run_both(first)
        for origin in ("stock", "subset"):
            again = script("PROGRAM.txt", MODEL, runs=(60,))
            again = again.replace("read_data       data.box", f"read_restart {origin}.restart")
            self.run_both(again)
            self.compare_dumps()
        for name in ("stock", "subset"):
            again = script("PROGRAM.txt", MODEL, runs=(60,))
            again = again.replace("read_data       data.box", f"read_restart {name}.restart")
            self.run_script(again.replace("PROGRAM", name), 1, LIGGGHTS)
        self.compare_dumps()

    def test_contacts_for_output(self):
        more = """
compute         pairs all pair/gran/local id force torque history
dump            l all local 20 PROGRAM.local c_pairs[1] c_pairs[2] c_pairs[4] c_pairs[5] c_pairs[6] &
                c_pairs[7] c_pairs[8] c_pairs[9] c_pairs[10] c_pairs[11] c_pairs[12] c_pairs[13] c_pairs[14] c_pairs[15]
dump_modify     l format "%.0f %.0f %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
"""
        self.run_both(script("PROGRAM.txt", MODEL, more=more, runs=(61,)))
        self.compare_dumps()

        def contacts(name):
            found = []
            for part in self.read(name).split("ITEM: ENTRIES")[1:]:
                rows = {}
                for line in part.split("ITEM:")[0].splitlines()[1:]:
                    numbers = [float(word) for word in line.split()]
                    a, b = int(numbers[0]), int(numbers[1])
                    # Seen from the lower id; through a periodic side the same pair may touch twice.
                    rows.setdefault((min(a, b), max(a, b)), []).append([x if a < b else -x for x in numbers[2:]])
                found.append(rows)
            return found

        stock, ours = contacts("stock.local"), contacts("subset.local")
        self.assertEqual(len(stock), len(ours))
        for a, b in zip(stock, ours):
            self.assertEqual(a.keys(), b.keys())
            self.assertGreater(len(a), 100)
            forces = lambda rows: [max(row)[:3] for _, row in sorted(rows.items())]
            memory = lambda rows: [max(row)[6:] for _, row in sorted(rows.items())]
            self.compare_rows(forces(a), forces(b), AFTER_100)
            self.compare_rows(memory(a), memory(b), AFTER_100)

    def test_virial(self):
        more = """
compute         still all temp
compute         push all pressure still pair
compute         stress all stress/atom pair
compute         total all reduce sum c_stress[1] c_stress[5]
thermo          7
"""
        text = script("PROGRAM.txt", MODEL, more=more, runs=(60,))
        text = text.replace("step atoms ke", "step atoms ke c_push[1] c_push[2] c_push[5] c_total[1] c_total[2]")
        text = text.replace("norm no", "norm no format float %.17g")
        for threads in (1, 2):
            stock, ours = map(thermo_rows, self.run_both(text, threads=threads))
            self.compare_rows(stock, ours, AFTER_100)
            self.compare_dumps()

    def test_heat(self):
        more = """
fix             tc all property/global thermalConductivity peratomtype 100 50
fix             th all property/global thermalCapacity peratomtype 10 20
group           hot id 1:40
fix             heat all heat/gran initial_temperature 300
set             group hot property/atom Temp 500
compute         temp all reduce sum f_Temp[0]
compute         least all reduce min f_Temp[0]
compute         most all reduce max f_Temp[0]
thermo          10
"""
        text = script("PROGRAM.txt", MODEL, more=more, runs=(100,))
        text = text.replace("set             group hot", "run 0\nset             group hot")
        text = text.replace("step atoms ke", "step atoms ke c_temp c_least c_most")
        text = text.replace("norm no", "norm no format float %.17g")
        stock, ours = self.run_both(text)
        self.assertIn(BY_SUBSET, ours)
        self.compare_rows(thermo_rows(stock), thermo_rows(ours), 1e-12)
        self.assertGreater(len({row[-1] for row in thermo_rows(ours)}), 5)  # heat flows

    def test_insertion(self):
        more = """
fix             one all particletemplate/sphere 15485863 atom_type 1 density constant 2000 radius constant 0.0008
fix             all all particledistribution/discrete 32452843 1 one 1.0
region          above block 0.001 0.009 0.001 0.009 0.011 0.02 units box
fix             ins all insert/pack seed 49979687 distributiontemplate all insert_every 25 overlapcheck yes &
                vel constant 0 0 -1 region above particles_in_region 60
"""
        text = script("PROGRAM.txt", MODEL, boundary="f f f", more=more, runs=(120,), step=1e-5)
        text = text.replace("dump_modify     d sort id", "dump_modify     d first no sort id")
        text = text.replace("dump            d all custom 1 ", "dump            d all custom 20 ")
        box = dense(cells=5)
        tall = "\n".join(
            "0 0.03 zlo zhi" if line.endswith("zlo zhi") else line for line in box.splitlines()
        )
        self.write("data.box", tall + "\n")
        walls = f"fix floor all wall/gran {MODEL} primitive type 1 zplane 0.0\n"
        text = text.replace("thermo_style", walls + "thermo_style", 1)
        stock, ours = self.run_both(text)
        self.assertIn(BY_SUBSET, ours)
        self.assertGreater(thermo_rows(ours)[-1][1], 150)
        self.compare_dumps(limit=1e-8)  # two runs of the stock program on 1 and 2 ranks are as far apart

    def test_what_is_alike_and_is_no_more(self):
        """All of one size, and of type 2 of two in the tables; then commands between runs, and insertion,
        bring in others."""
        floor = f"fix floor all wall/gran {MODEL} primitive type 1 zplane 0.0\n"
        text = script("PROGRAM.txt", MODEL, boundary="p p f", more="group some id 10:60", runs=(40,), step=1e-5)
        text = text.replace("thermo_style", "set group all type 2\n" + floor + "thermo_style", 1)
        text = text.replace("dump_modify     d sort id", "dump_modify     d first no sort id")
        for change in ("type 1", "type 2", "diameter 0.00206", "diameter 0.002", "density 2500", "density 2000"):
            text += f"set group some {change}\nrun 15 pre no\n"
        text += """
fix             one all particletemplate/sphere 15485863 atom_type 1 density constant 2000 radius constant 0.0008
fix             all all particledistribution/discrete 32452843 1 one 1.0
region          above block 0.001 0.009 0.001 0.009 0.0105 0.014 units box
fix             ins all insert/pack seed 49979687 distributiontemplate all insert_every once start 155 overlapcheck yes &
                vel constant 0 0 -3 region above particles_in_region 25
run             100
"""
        box = dense(cells=5, types=1, sizes=(1, 1)).replace("1 atom types", "2 atom types").splitlines()
        self.write("data.box", "\n".join("0 0.03 zlo zhi" if "zlo zhi" in line else line for line in box) + "\n")
        stock, ours = self.run_both(text)
        self.assertIn(BY_SUBSET, ours)
        self.assertGreater(thermo_rows(ours)[-1][1], 140)
        self.compare_dumps(limit=1e-8)  # as for insertion

    def test_growing_spheres(self):
        """They grow on the steps on which lists are built, after that: who touches by growing alone had
        parted, and has no memory."""
        more = """
neigh_modify    every 7 check no
compute         radius all property/atom radius
variable        grown atom 1.004*2*c_radius
fix             grow all adapt 7 atom diameter v_grown
"""
        for sizes, types in (((0.85, 1.1), 2), ((1, 1), 1)):
            with self.subTest(sizes=sizes):
                box = data_file((7, 7, 7), 1.03, 0.5, 50.0, 0.02, sizes=sizes, types=types)
                self.write("data.box", box.replace("1 atom types", "2 atom types"))
                _, ours = self.run_both(script("PROGRAM.txt", MODEL, more=more, runs=(100,), step=5e-6))
                self.assertIn(BY_SUBSET, ours)
                self.compare_dumps()

    def test_change_of_path(self):
        """Contacts keep their memory when a run goes by LIGGGHTS' own loop, and when the next does not."""
        text = script("PROGRAM.txt", MODEL, runs=(40,))
        text += "neigh_modify contact_distance_factor 1.1\nrun 40\n"
        text += "neigh_modify contact_distance_factor 1.0\nrun 40\n"
        _, ours = self.run_both(text)
        self.assertIn(BY_SUBSET, ours)
        self.assertIn("contact_distance_factor has no form by particle subset", ours)
        self.compare_dumps()

    def test_own_loop_where_there_is_no_other(self):
        model = words("hertz", "tangential history", "", "rolling_friction epsd3")
        more = "fix rv all property/global coefficientRollingViscousDamping peratomtypepair 2 .1 .1 .1 .1\nfix ks all property/global rollingStiffness scalar 2.25\n"
        _, ours = self.run_both(script("PROGRAM.txt", model, more=more, runs=(30,)))
        self.assertEqual(ours.count("rolling_friction epsd3 has no form by particle subset"), 1)
        self.assertNotIn(BY_SUBSET, ours)
        self.assertTrue(self.read("stock.txt") == self.read("subset.txt"))

    def test_several_runs_without_setup(self):
        text = script("PROGRAM.txt", MODEL, runs=(20,)) + "run 20 pre no post no\nrun 20 pre no\nrun 0\nrun 20\n"
        self.run_both(text)
        self.compare_dumps()


if __name__ == "__main__":
    unittest.main()
