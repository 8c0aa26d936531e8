# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Options -threads and -subset of the launcher."""

import os
import re
import subprocess
import unittest
from unittest import mock

from host import GRANFLUX, HostTest

from beside_stock import SPHERES, STIFFNESS, run_and_dump

BED = SPHERES.format(spacing=2.2e-3) + STIFFNESS + "fix move all nve/sphere\n" + run_and_dump()


class ThreadOptions(HostTest):
    def test_bad_values(self):
        for words, complaint in (
            (["-threads", "0"], "-threads is '0': allowed is a whole number from 1 to 1024"),
            (["-threads", "two"], "-threads is 'two'"),
            (["-threads", "2.5"], "-threads is '2.5'"),
            (["-threads", "-1"], "-threads is '-1'"),
            (["-subset", "maybe"], "-subset is 'maybe': allowed is on or off"),
            (["-subset"], "-subset needs a value"),
        ):
            with self.subTest(words):
                code, output = self.start("print unused\n", ranks=2, options=words)
                self.assertNotEqual(code, 0)
                self.assertEqual(output.count("ERROR: " + complaint), 1, output)
                self.assertNotIn("unused", output)

    def test_bad_environment(self):
        with mock.patch.dict(os.environ, OMP_NUM_THREADS="many"):
            code, output = self.start("print unused\n")
        self.assertNotEqual(code, 0)
        self.assertIn("ERROR: OMP_NUM_THREADS is 'many'", output)

    def test_threads_of_the_environment(self):
        with mock.patch.dict(os.environ, OMP_NUM_THREADS="2,4"):
            self.assertIn("granflux: 2 threads a rank", self.run_script("print used\n"))
        with mock.patch.dict(os.environ, OMP_NUM_THREADS="1"):
            self.assertNotIn("threads a rank", self.run_script("print used\n"))

    def test_too_few_processors(self):
        """Threads that have to share a processor are worth a word."""
        self.write("in.test", "print used\n")
        done = subprocess.run(["taskset", "-c", "0", GRANFLUX, "-threads", "2", "-in", "in.test"],
                              cwd=self.folder, capture_output=True, text=True, check=True)
        self.assertIn("2 threads a rank, but a rank may use 1 processor only", done.stdout)

    def test_switched_off(self):
        self.run_script(BED, options=["-subset", "off", "-threads", "2"])

    def test_report_at_the_end_of_a_run(self):
        table = r"granflux: particle work of 2 ranks x 2 threads, (\d+) particles, (\d+) steps"
        output = self.run_script(BED + "run 3 pre no\n", ranks=2, options=["-threads", "2"])
        self.assertEqual(re.findall(table, output), [("729", "1"), ("729", "99")])
        last = output[output.rindex("granflux: particle work"):]
        rows = {name.strip(): [float(word) for word in words.split()] for name, words in
                re.findall(r"^  ([a-z][a-z ]*?) {2,}([-\d. ]+)$", last, re.M)}
        parts = [rows[name][0] for name in ("contacts", "walls", "integration", "other fixes",
                                            "neighbour lists", "communication", "output")]
        self.assertTrue(all(seconds >= 0 for seconds in parts))
        self.assertLessEqual(sum(parts), rows["total"][0] * 1.001 + 1e-3)
        self.assertAlmostEqual(rows["particles a rank"][0], 729 / 2, delta=1)
        self.assertAlmostEqual(rows["particles a thread"][0], 729 / 4, delta=1)
        self.assertGreater(rows["ghosts a rank"][0], 0)
        off = self.run_script(BED, ranks=2, options=["-threads", "2", "-subset", "off"])
        self.assertNotIn("particle work", off)

    def test_options_stay_out_of_the_script(self):
        """LIGGGHTS sees its own options only, wherever ours stand."""
        script = 'print "said ${word}"\n'
        for options in (["-threads", "2", "-var", "word", "hello"],
                        ["-var", "word", "hello", "-subset", "off", "-threads", "1"]):
            self.assertIn("said hello", self.run_script(script, options=options))


if __name__ == "__main__":
    unittest.main()
