# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Wrong cases are refused before anything runs, by a message that names key, value and what is allowed."""

import contextlib
import io
import shutil
import tempfile
import tomllib
import unittest
from pathlib import Path

from granflux_study.case import read_study
from granflux_study.bad_input import BadInput
from granflux_study.command_line import main
from granflux_study.outputs import read_series
from granflux_study.toml_text import toml_text

HERE = Path(__file__).resolve().parent
SCRIPT = "variable dt index 1e-5\nvariable steps equal 100\nrun ${steps}\n"


class Folder(unittest.TestCase):
    def setUp(self):
        self.case = Path(tempfile.mkdtemp())
        shutil.copy(HERE / "channel/channel.toml", self.case)
        (self.case / "in.run").write_text(SCRIPT)
        self.text = (HERE / "channel/study.toml").read_text().replace('["channel.toml"]', '["channel.toml", "in.run"]')

    def tearDown(self):
        shutil.rmtree(self.case)

    def refused(self, old, new, *words):
        self.assertIn(old, self.text)
        (self.case / "study.toml").write_text(self.text.replace(old, new, 1))
        with self.assertRaises(BadInput) as caught:
            read_study(self.case)
        for word in words:
            self.assertIn(word, str(caught.exception))


class BadCases(Folder):
    def test_the_case_is_right_as_it_is(self):
        (self.case / "study.toml").write_text(self.text)
        self.assertEqual([k.base for k in read_study(self.case).knobs], ["32", "0.01", "limited"])

    def test_two_knobs_that_set_the_same(self):
        self.refused("channel.toml:numerics.convection", "channel.toml:numerics.time_step", "both set channel.toml:numerics.time_step",
                     "one knob must set it")

    def test_unknown_keys(self):
        self.refused("simulated_time = 0.4", "simulated_time = 0.4\nthread = 2", "[run] thread", "did you mean threads?")
        self.refused("closed_form", "closed_from", "closed_from", "did you mean closed_form?")
        self.refused('unit = "s"', 'untis = "s"', '"gas step" untis', "did you mean unit?")

    def test_missing_and_wrong_values(self):
        self.refused("simulated_time = 0.4", "simulated_time = -1", "simulated_time = -1", "a number > 0")
        self.refused("simulated_time = 0.4", "", "simulated_time: missing")
        self.refused("simulated_time = 0.4", "simulated_time = 0.4\nranks = 1.5", "ranks = 1.5", "whole number >= 1")
        self.refused('title = "Developed flow between two plates"', 'title = "x"\nchaotic = 1', "chaotic = 1", "true or false")
        self.refused("values = [0.02, 0.01]", "values = [0.01]", "values = [0.01]", "two values or more")
        self.refused("values = [0.02, 0.01]", "values = [0.01, 0.01]", "two are called 0.01")
        self.refused("values = [0.02, 0.01]", "values = [0.02, 0.01]\nbase = 0.03", "base = 0.03", "0.02, 0.01")
        self.refused('format = "printed"', 'format = "print"', 'format = \'print\'', '"printed"')

    def test_knobs_that_set_nothing(self):
        self.refused("numerics.time_step", "numerics.time_stp", "channel.toml has no key numerics.time_stp", "numerics.time_step")
        self.refused("channel.toml:numerics.time_step", "duct.toml:numerics.time_step", "FILE:TABLE.KEY", "channel.toml")
        self.refused('key = "channel.toml:numerics.time_step"', 'variable = "step"', "variable step index", "dt")
        self.refused('key = "channel.toml:numerics.time_step"', 'variable = "steps"', "variable steps index", "dt")
        self.refused('key = "channel.toml:numerics.time_step"', 'variable = "dt"\nkey = "x"', "one of variable, key, option, levels")

    def test_references(self):
        self.refused("[run]", 'reference = "best"\n[run]', "reference = 'best'", '"finest"')
        self.refused("[run]", '[reference]\n"gas step" = 0.5\n[run]', "gas step = 0.5", "0.02, 0.01")
        self.refused("[run]", '[reference]\n"gas stop" = 0.01\n[run]', "gas stop", "did you mean gas step?")
        self.refused("closed_form = 0.24", "closed_form = 0", "scale")
        self.refused("closed_form = 0.24", 'against = "profile.txt"', "profile.txt")

    def test_files_and_programs(self):
        self.refused('files = ["channel.toml"', 'files = ["duct.toml"', "there is no file", "duct.toml")
        (self.case / "study.toml").write_text(self.text.replace('command = ["granflux_cfd"', 'command = ["granflux_xyz"'))
        self.assertIn("granflux_xyz: there is no such program", self.told(str(self.case)))

    def told(self, *words):
        with contextlib.redirect_stderr(io.StringIO()) as errors:
            self.assertEqual(main(list(words), io.StringIO()), 2)
        return errors.getvalue()

    def test_command_line(self):
        (self.case / "study.toml").write_text(self.text)
        self.assertIn("study.toml", self.told(str(self.case / "nowhere")))
        self.assertIn("0.05 for 5 %", self.told(str(self.case), "--error", "0"))
        self.assertIn("must be one of pressure drop", self.told(str(self.case), "--quantity", "height"))
        self.assertIn("--jobs", self.told(str(self.case), "--jobs", "0"))


class Outputs(Folder):
    def read(self, text, **what):
        from types import SimpleNamespace

        path = self.case / "log"
        path.write_text(text)
        quantity = SimpleNamespace(**{"name": "q", "file": "log", "factor": 2.0, "column": "", "pattern": "", **what})
        return read_series(path, quantity, 0.5)

    def test_the_last_table_of_a_log_that_has_the_column(self):
        log = ("Step Time f_gas[1]\n 0 0 1\nLoop time of 1\nStep Time gas[1]\n 0 0 5\nWARNING: x\n 10 0.1 6\n"
               "Loop time of 2\n 1 2 3\nStep ke\n 0 9\nLoop time\n")
        times, values = self.read(log, form="thermo", column="f_gas[1]")
        np_list = [times.tolist(), values.tolist()]
        self.assertEqual(np_list, [[0.0, 0.1], [[10.0], [12.0]]])
        with self.assertRaisesRegex(BadInput, "no table with a column f_gas\\[2\\]"):
            self.read(log, form="thermo", column="f_gas[2]")

    def test_profiles_and_their_times(self):
        text = "# x\n# Timestep n\n# Bin Coord Ncount v\n0 2\n 1 0.5 3 1\n 2 1.5 3 2\n100 2\n 1 0.5 3 3\n 2 1.5 3 4\n200 2\n 1 0.5 3 5\n"
        times, values = self.read(text, form="profile", column="v")
        self.assertEqual([times.tolist(), values.tolist()], [[0.0, 0.5], [[2.0, 4.0], [6.0, 8.0]]])  # the last is torn

    def test_tables_with_commas_and_blanks(self):
        for text in ("t,a,b\n0,1,2\n1,3,4\n", "# t a b\n0 1 2\n1 3 4\n"):
            times, values = self.read(text, form="table", column="b")
            self.assertEqual([times.tolist(), values.tolist()], [[0.0, 1.0], [[4.0], [8.0]]])

    def test_numbers_that_are_printed(self):
        self.assertEqual(self.read("p 1 Pa\np 2 Pa\n", form="printed", pattern=r"p (\S+) Pa")[1].tolist(), [[4.0]])
        for pattern in (r"q (\S+)", r"(p) \S+", "("):
            with self.assertRaises(BadInput):
                self.read("p 1 Pa\n", form="printed", pattern=pattern)


class TomlText(unittest.TestCase):
    def test_it_reads_back_as_it_was(self):
        for path in [HERE / "channel/channel.toml", *HERE.parent.parent.glob("examples/*/*.toml")]:
            document = tomllib.loads(path.read_text())
            self.assertEqual(tomllib.loads(toml_text(document)), document, path)
        odd = {"a b": 'x "y" \\ é', "e": [], "t": {"u": {"v": [[1, 2.5], [True]]}, "w": {}}, "many": [{"k": 1}, {"k": {"z": 1e-300}}]}
        self.assertEqual(tomllib.loads(toml_text(odd)), odd)


class CommittedStudies(unittest.TestCase):
    def test_every_study_of_the_examples_is_right(self):
        folders = [path.parent for path in HERE.parent.parent.glob("examples/studies/*/study.toml")]
        self.assertGreaterEqual(len(folders), 4)
        for folder in folders:
            read_study(folder)


if __name__ == "__main__":
    unittest.main()
