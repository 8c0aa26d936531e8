# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checkpoints of LAMMPS: with its own pair styles, a run that is continued is the run that was not stopped."""

import re
import signal
import subprocess
import time
import unittest

from host import MPIRUN, couple, largest_difference, last_snapshot, thermo_rows
from two_hosts import GRANFLUX_LAMMPS, TwoHostTest, dump, lammps_bed, thermo
from test_lammps_heat import HEAT, WARM_CASE

BED = "read_data spheres.data"
AGAIN = "read_restart bed.checkpoint"


def script(name, every, source, history=True, gas=True):
    physics = HEAT.format(words="") + (couple(10) + thermo(100) if gas else "thermo_modify lost error norm no\n")
    return lammps_bed(history, source) + physics + dump(name, every=200) + f"fix keep all granflux/checkpoint bed.checkpoint every {every}\n"


class Checkpoint(TwoHostTest):
    def setUp(self):
        super().setUp()
        self.write("case.toml", WARM_CASE)

    def last(self, name):
        return last_snapshot(self.read(name))

    def test_continues_bit_for_bit(self):
        for every, ranks, history, gas in ((60, 1, True, True), (65, 2, True, True), (65, 1, False, False)):
            with self.subTest(every=every, ranks=ranks, history=history, gas=gas):
                whole = self.run_lammps(script("whole", every, BED, history, gas) + "run 200\n", ranks)
                self.run_lammps(script("first", every, BED, history, gas) + f"run {2 * every + 30}\n", ranks)
                again = self.run_lammps(script("again", every, AGAIN, history, gas) + "run 200 upto\n", ranks)
                self.assertNotIn("not to the last bit", again)
                self.assertEqual(thermo_rows(again)[0][0], 2 * every)
                self.assertEqual(self.last("whole"), self.last("again"))
                self.assertEqual(thermo_rows(whole)[-1], thermo_rows(again)[-1])

    def test_a_signal_leaves_no_trace(self):
        two_runs = "run 130\n{}run 270\n"
        self.run_lammps(script("whole", 0, BED) + two_runs.format(""))
        output = self.run_lammps(script("first", 0, BED) + two_runs.format('shell "kill -TERM $PPID"\n'))
        step = int(re.search(r"stopped by a signal after step (\d+); (.*)", output)[1])
        self.assertTrue(130 < step < 399, step)
        self.assertNotIn("the same to rounding", output)
        self.run_lammps(script("again", 0, AGAIN) + "run 400 upto\n")
        self.assertEqual(self.last("whole"), self.last("again"))

    def test_other_fixes_are_refused(self):
        self.run_lammps(script("first", 50, BED) + "run 60\n")
        code, output = self.start_lammps(script("again", 50, AGAIN).replace("fix gas all", "fix air all").replace("f_gas", "f_air") + "run 1\n")
        self.assertNotEqual(code, 0)
        self.assertIn("of fix gas (style granflux/couple), which the script does not have; is it fix air?", output)

    def test_on_another_number_of_ranks(self):
        self.run_lammps(script("first", 60, BED) + "run 70\n", 2)
        self.run_lammps(script("same", 1000, AGAIN) + "run 200 upto\n", 2)
        self.run_lammps(script("again", 1000, AGAIN) + "run 200 upto\n", 1)
        self.assertLess(largest_difference(self.last("same"), self.last("again"), columns=6), 1e-9)

    def test_stops_by_signal_and_continues(self):
        self.write("in.test", script("first", 100, BED) + "run 100000000\n")
        command = [*MPIRUN, "--timeout", "60", "-n", "2", GRANFLUX_LAMMPS, "-in", "in.test"]
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.stdout.close)
        while process.poll() is None and not (self.folder / "bed.checkpoint").exists():
            time.sleep(0.05)
        process.send_signal(signal.SIGUSR2)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, output)
        step = int(re.search(r"stopped by a signal after step (\d+)", output)[1])
        self.assertEqual(thermo_rows(self.run_lammps(script("again", 100, AGAIN) + "run 10\n", 2))[0][0], step)

    def test_damaged_files_are_refused(self):
        self.run_lammps(script("first", 50, BED) + "run 50\n")
        whole = (self.folder / "bed.checkpoint").read_bytes()
        damaged = bytearray(whole)
        damaged[len(whole) // 2] ^= 1
        for content in (damaged, whole[: len(whole) // 2]):
            (self.folder / "bed.checkpoint").write_bytes(content)
            code, output = self.start_lammps(script("again", 50, AGAIN) + "run 1\n")
            self.assertNotEqual(code, 0)
            self.assertIn("checkpoint bed.checkpoint: it is ", output)


if __name__ == "__main__":
    unittest.main()
