# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checkpoints: a run that is stopped and continued is the run that was not, on any number of ranks; by signals too."""

import re
import signal
import subprocess
import time
import unittest

from host import (
    CASE,
    GRANFLUX,
    MPIRUN,
    HostTest,
    bed,
    bed_from,
    couple,
    largest_difference,
    last_snapshot,
    thermo_rows,
)

ENERGY = """
[energy]
heat_capacity = 1000
conductivity = 0.026
initial_temperature = 300
"""

HEAT = """
fix             yo all property/global youngsModulusOriginal peratomtype 70e9
fix             pr all property/global poissonsRatio peratomtype 0.3
fix             tk all property/global thermalConductivity peratomtype 1
fix             tc all property/global thermalCapacity peratomtype 0.5
fix             heat all granflux/heat initial_temperature 400 damping on
"""
THERMO = (
    "thermo_style custom step atoms ke f_gas[24] f_heat f_gas[11] f_gas[32]\n"
    "thermo_modify lost error norm no format float %.17g\nthermo 100\n"
)
THERMO_ALONE = "thermo_style custom step atoms ke f_heat\nthermo_modify lost error norm no format float %.17g\nthermo 100\n"
DUMP = (
    "dump t all custom {every} {name} id x y z vx vy vz omegax omegay omegaz f_Temp mass\n"
    'dump_modify t sort id format "%d' + " %.17g" * 11 + '"\n'
)


def fix(every, name="bed.checkpoint"):
    return f"fix keep all granflux/checkpoint {name} every {every}\n"


class Checkpoint(HostTest):
    def setUp(self):
        super().setUp()
        warm = CASE.replace("velocity = [0, 0, 0.5]", "velocity = [0, 0, 0.5]\ntemperature = 300")
        self.write("case.toml", warm + ENERGY)

    def physics(self, every, name, gas=True):
        return HEAT + (couple(10) + THERMO if gas else THERMO_ALONE) + DUMP.format(every=100, name=name) + fix(every)

    def begin(self, every=60, name="whole", gas=True):
        return bed() + self.physics(every, name, gas)

    def go_on(self, every=60, name="again", gas=True):
        return bed_from("bed.checkpoint") + self.physics(every, name, gas)

    def last(self, name):
        return last_snapshot(self.read(name))

    def test_continues_bit_for_bit(self):
        # Checkpoints at steps with and without a gas step.
        for every, ranks, threads, gas in ((60, 1, 1, True), (65, 1, 2, True), (60, 2, 2, True), (65, 2, 1, False)):
            with self.subTest(every=every, ranks=ranks, threads=threads, gas=gas):
                options = ("-threads", str(threads))
                whole = thermo_rows(self.run_script(self.begin(every, gas=gas) + "run 300\n", ranks, options=options))
                self.run_script(self.begin(every, "first", gas) + f"run {2 * every + 30}\n", ranks, options=options)
                output = self.run_script(self.go_on(every, gas=gas) + "run 300 upto\n", ranks, options=options)
                self.assertNotIn("not to the last bit", output)
                self.assertEqual(thermo_rows(output)[0][0], 2 * every)
                self.assertEqual(self.last("whole"), self.last("again"))
                self.assertEqual(whole[-1], thermo_rows(output)[-1])

    def test_gas_steps_that_follow_a_courant_number(self):
        # Each as many particle steps as keep it; the count goes on where it was.
        self.write("case.toml", self.read("case.toml") + "\n[numerics]\ncourant = 0.02\n")
        gas = "f_gas[24] f_gas[15] f_gas[21] f_gas[14]"
        begin, go_on = (script(65).replace("f_gas[24]", gas) for script in (self.begin, self.go_on))
        whole = thermo_rows(self.run_script(begin + "run 300\n"))
        *_, courant, gas_steps, gas_time, _, _, _ = whole[-1]
        self.assertTrue(0.014 < courant < 0.0205, courant)
        self.assertTrue(45 < gas_steps < 150, gas_steps)  # 31 would be all of ten
        self.assertTrue(300e-5 <= gas_time < 310e-5, gas_time)
        self.assertGreater(max(row[4] for row in whole), 0.014)
        self.run_script(begin.replace("whole", "first") + "run 160\n")
        output = self.run_script(go_on + "run 300 upto\n")
        self.assertEqual(self.last("whole"), self.last("again"))
        self.assertEqual(whole[-1], thermo_rows(output)[-1])
        # One that is never reached changes nothing.
        self.write("case.toml", self.read("case.toml").replace("0.02", "5"))
        loose = thermo_rows(self.run_script(begin + "run 100\n"))[-1]
        self.write("case.toml", self.read("case.toml").replace("courant = 5", ""))
        self.assertEqual(loose, thermo_rows(self.run_script(begin + "run 100\n"))[-1])

    def test_a_signal_leaves_no_trace(self):
        # It waits for the next lists that the run builds anyway. The shell of the script signals the program.
        for ranks, gas in ((1, True), (2, False)):
            with self.subTest(ranks=ranks, gas=gas):
                script = "run 130\n{}run 370\n"
                self.run_script(self.begin(0, gas=gas) + script.format(""), ranks)
                output = self.run_script(self.begin(0, "first", gas) + script.format('shell "kill -TERM $PPID"\n'), ranks)
                step = int(re.search(r"stopped by a signal after step (\d+); (.*)", output)[1])
                self.assertTrue(130 < step < 499, step)
                self.assertNotIn("the same to rounding", output)
                output = self.run_script(self.go_on(0, gas=gas) + "run 500 upto\n", ranks)
                self.assertEqual(thermo_rows(output)[0][0], step)
                self.assertEqual(self.last("whole"), self.last("again"))

    def test_a_signal_does_not_wait_for_lists_of_particles_at_rest(self):
        still = self.begin(0).replace("fix             move all nve/sphere\n", "")
        output = self.run_script(still + 'run 130\nshell "kill -TERM $PPID"\nrun 40\n')  # the end of the run
        self.assertIn("stopped by a signal after step 170; ", output)
        self.assertIn("lists were built for it: the same to rounding", output)

    def test_other_fixes_are_refused(self):
        self.run_script(self.begin(50, "first") + "run 60\n")
        script = self.go_on()
        for old, new, text in (
            ("fix gas all", "fix air all", "of fix gas (style granflux/couple), which the script does not have; is it fix air?"),
            (HEAT[HEAT.index("fix             heat") :], "", "of fix heat (style granflux/heat), which the script does not have: it would"),
            ("fix             zlow all wall/gran", "fix floor all wall/gran", "the state of fix history_zlow"),
        ):
            with self.subTest(text=text):
                thermo = THERMO.replace("f_gas", "f_air") if "air" in new else THERMO if new else THERMO.replace("f_heat ", "")
                changed = script.replace(THERMO, thermo).replace(old, new)
                self.assertNotEqual(changed, script)
                code, output = self.start((changed if new else changed.replace(" f_Temp", " id")) + "run 1\n")
                self.assertNotEqual(code, 0)
                self.assertIn(text, output)

    def test_a_checkpoint_of_another_fix_is_a_plain_restart_file(self):
        self.run_script(self.begin(50, "first") + "run 60\n")
        other = self.go_on().replace("fix keep all", "fix kept all").replace("fix gas all", "fix air all").replace("f_gas", "f_air")
        self.assertEqual(thermo_rows(self.run_script(other + "run 1\n"))[0][0], 50)

    def test_on_another_number_of_ranks_and_threads(self):
        end = "run 160 upto\n"
        for start, others in ((2, ((1, 1), (4, 1), (2, 2))), (1, ((2, 1),))):
            self.run_script(self.begin(60, "first") + "run 70\n", start)
            same = thermo_rows(self.run_script(self.go_on(1000, "same") + end, start))[-1]
            particles = self.last("same")
            for ranks, threads in others:
                with self.subTest(start=start, ranks=ranks, threads=threads):
                    rows = thermo_rows(self.run_script(self.go_on(1000) + end, ranks, options=("-threads", str(threads))))
                    self.assertEqual(rows[0][0], 60)
                    self.assertLess(largest_difference(particles, self.last("again"), columns=6), 1e-9)
                    for column, scale in ((2, same[2]), (3, same[3]), (4, same[4])):  # energy, momentum of the gas, heat
                        self.assertLess(abs(rows[-1][column] - same[column]), 1e-10 * abs(scale))
                    self.assertLess(max(rows[-1][5:7]), 1e-12)

    def start_in_background(self, script, ranks=1, more=()):
        self.write("in.test", script)
        command = [*MPIRUN, "--timeout", "60", *more, "-n", str(ranks), GRANFLUX, "-in", "in.test"]
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
        self.addCleanup(process.stdout.close)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def wait_for_checkpoint(self, process):
        for _ in range(600):
            if (self.folder / "bed.checkpoint").exists():
                return
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        self.fail("no checkpoint")

    def programs_of(self, process):
        """Processes of the ranks of an mpirun."""
        children = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(process.pid)], stdout=subprocess.PIPE, text=True)
        return [int(line.split()[0]) for line in children.stdout.splitlines() if line.split()[1] == "granflux"]

    def test_stops_by_signal_and_continues(self):
        endless = "run 100000000\nrun 7\n"
        for ranks, name in ((1, "SIGTERM"), (2, "SIGUSR2")):
            with self.subTest(ranks=ranks, signal=name):
                process = self.start_in_background(self.begin(100) + endless, ranks)
                self.wait_for_checkpoint(process)
                if name == "SIGTERM":  # to one rank, as a batch system does
                    subprocess.run(["kill", "-TERM", str(self.programs_of(process)[0])], check=True)
                else:  # mpirun hands it on
                    process.send_signal(signal.SIGUSR2)
                output, _ = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 0, output)
                step = int(re.search(r"stopped by a signal after step (\d+); .*'read_restart bed.checkpoint'", output)[1])
                output = self.run_script(self.go_on(100) + "run 10\n", ranks)
                self.assertEqual(thermo_rows(output)[0][0], step)
                (self.folder / "bed.checkpoint").unlink()

    def test_checkpoint_by_signal(self):
        process = self.start_in_background(self.begin(0) + "run 100000000\n", 1)
        log = self.folder / "log.liggghts"
        while process.poll() is None and not (log.exists() and "granflux: gas of" in log.read_text()):
            time.sleep(0.05)
        process.send_signal(signal.SIGUSR1)
        self.wait_for_checkpoint(process)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGUSR2)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, output)

    def test_killed_rank(self):
        process = self.start_in_background(self.begin(50) + "run 100000000\n", 2)
        self.wait_for_checkpoint(process)
        subprocess.run(["kill", "-KILL", str(self.programs_of(process)[-1])], check=True)
        output, _ = process.communicate(timeout=20)
        self.assertNotEqual(process.returncode, 0)
        self.assertIn("signal 9", output)
        self.run_script(self.go_on(50) + "run 10\n", 2)

    def test_full_disk(self):
        self.run_script(self.begin(50, "first") + "run 60\n")
        before = (self.folder / "bed.checkpoint").read_bytes()
        self.assertGreater(len(before), 200 * 1024)
        code, output = self.start_limited(self.begin(50) + "run 100\n", "ulimit -f 100;", 2)
        self.assertNotEqual(code, 0)
        self.assertIn("checkpoint bed.checkpoint: File too large", output)
        self.assertEqual((self.folder / "bed.checkpoint").read_bytes(), before)
        self.assertFalse((self.folder / "bed.checkpoint.part").exists())
        self.run_script(self.go_on(50) + "run 10\n")

    def test_damaged_files_are_refused(self):
        self.run_script(self.begin(50, "first") + "run 60\n")
        whole = (self.folder / "bed.checkpoint").read_bytes()
        for place in (len(whole) // 40, len(whole) // 3, len(whole) - 5000, len(whole) - 50):
            damaged = bytearray(whole)
            damaged[place] ^= 4
            self.check_refused(damaged, "checkpoint bed.checkpoint: it is ")
        self.check_refused(whole[: len(whole) // 2], "checkpoint bed.checkpoint: it is incomplete")
        self.check_refused(whole[:-1], "checkpoint bed.checkpoint: it is ", ranks=2)

    def check_refused(self, content, text, ranks=1):
        (self.folder / "bed.checkpoint").write_bytes(content)
        code, output = self.start(self.go_on() + "run 1\n", ranks)
        self.assertNotEqual(code, 0)
        self.assertIn(text, output)
        self.assertIn("use an earlier one", output)

    def test_foreign_state_is_refused(self):
        self.run_script(self.begin(50, "first") + "run 60\n")
        for old, new, text in (
            ("cells = [5, 3, 20]", "cells = [5, 3, 18]", "another grid"),
            (ENERGY, "", "other equations"),
        ):
            with self.subTest(text=text):
                case = self.read("case.toml")
                self.write("case.toml", case.replace(old, new).replace("temperature = 300\n" if not new else "\r", ""))
                code, output = self.start(self.go_on() + "run 1\n", 2)
                self.assertNotEqual(code, 0)
                self.assertIn("the gas of the restart file: it is of", output)
                self.assertIn(text, output)
                self.write("case.toml", case)

    def test_a_run_that_fails_names_the_last_checkpoint(self):
        fails = "run 60\nset group all density 1000 diameter 3e-3\nrun 10\n"
        code, output = self.start(self.begin(50) + fails)
        self.assertNotEqual(code, 0)
        self.assertIn("last good state: checkpoint bed.checkpoint of step 50", output)

    def test_bad_input(self):
        physics = self.begin().replace(fix(60), "{}\n")
        for line, text in (
            (fix(10, "no_folder/bed.checkpoint"), "no_folder/bed.checkpoint: No such file or directory"),
            (fix("-1"), "every -1: must be a whole number of steps"),
            (fix(10, "bed.*"), "without * and %"),
            ("fix keep all granflux/checkpoint bed.checkpoint\n", "expected is FILE every N"),
            (fix(10) + "fix push all addforce 0 0 0\n", "define it last"),
        ):
            with self.subTest(text=text):
                code, output = self.start(physics.replace("{}", line) + "run 1\n")
                self.assertNotEqual(code, 0)
                self.assertIn(text, output)


if __name__ == "__main__":
    unittest.main()
