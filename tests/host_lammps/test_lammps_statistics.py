# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A bubbling bed for long through LIGGGHTS and through LAMMPS: the particles' paths have long since parted,
means over the run are the same within what blocks of the run differ by.

With FILE in the environment variable GRANFLUX_PARITY the table is also written there as CSV.
"""

import csv
import math
import os
import statistics
import unittest

import host
from host import CASE, couple, thermo_rows
from two_hosts import TIME_STEP, TwoHostTest, data_file, lammps_bed, liggghts_bed

host.TIMEOUT = 3000  # s
LAYERS = 18  # of 9 x 5 spheres of 1 mm
VELOCITY = 0.8  # m/s, of the gas: two and a half times what lifts the bed
TIME, SETTLED, BLOCKS = 4.0, 0.8, 8  # s, s of them left out, blocks of the rest
EVERY = 100  # steps between two lines
COLUMNS = ("pressure drop [Pa]", "drag [N]", "height of the centre [m]", "kinetic energy [J]", "least void fraction")
THERMO = f"""
variable        height equal xcm(all,z)
thermo_style    custom step f_gas[1] f_gas[4] v_height c_kinetic f_gas[8] f_gas[11]
thermo_modify   lost error norm no format {{of_line}}%.17g
thermo          {EVERY}
"""


class Statistics(TwoHostTest):
    def series(self, lammps, history):
        bed, run = (lammps_bed, self.run_lammps) if lammps else (liggghts_bed, self.run_script)
        script = bed(history) + couple(10) + THERMO.format(of_line="float ")
        rows = thermo_rows(run(script + f"run {round(TIME / TIME_STEP)}\n"))
        self.assertLess(max(row[-1] for row in rows), 1e-12)  # momentum handed over
        return [row[1:-1] for row in rows if row[0] * TIME_STEP > SETTLED]

    def means_and_errors(self, rows):
        """Of each column: its mean and the standard error of it, from means of blocks."""
        length = len(rows) // BLOCKS
        found = []
        for column in zip(*rows):
            blocks = [statistics.fmean(column[n * length : (n + 1) * length]) for n in range(BLOCKS)]
            found.append((statistics.fmean(blocks), statistics.stdev(blocks) / math.sqrt(BLOCKS)))
        return found

    def test_means_of_a_bubbling_bed(self):
        rows = [
            ((1.05e-3 * (i + 0.6), 1.1e-3 * (j + 0.6), 1.02e-3 * (k + 0.6)), (0.02 * (i - 4), 0.03 * (j - 2), 0))
            for k in range(LAYERS)
            for j in range(5)
            for i in range(9)
        ]
        self.write("spheres.data", data_file(rows))
        self.write("case.toml", CASE.replace("[0, 0, 0.5]", f"[0, 0, {VELOCITY}]"))
        table = []
        for history in (False, True):
            both = [self.means_and_errors(self.series(lammps, history)) for lammps in (False, True)]
            for name, (a, a_error), (b, b_error) in zip(COLUMNS, *both):
                apart = (b - a) / math.hypot(a_error, b_error)
                table.append(["friction" if history else "no friction", name, a, a_error, b, b_error, apart])
                print(*(f"{x:.4g}" if isinstance(x, float) else x for x in table[-1]), sep=", ")
        if path := os.environ.get("GRANFLUX_PARITY"):
            with open(path, "w", newline="") as file:
                writer = csv.writer(file)
                writer.writerow(["contacts", "mean of", "LIGGGHTS", "error", "LAMMPS", "error", "apart, in errors"])
                writer.writerows([*row[:2], *(f"{x:.5g}" for x in row[2:])] for row in table)
        for contacts, name, *_, apart in table:
            if contacts == "no friction":  # with it the hosts' laws differ, see test_lammps_parity.py
                self.assertLess(abs(apart), 3, name)


if __name__ == "__main__":
    unittest.main()
