# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""granflux-regress sees what differs, passes what does not, and refuses what it cannot compare."""

import contextlib
import gzip
import io
import pathlib
import tempfile
import unittest

import numpy as np

from granflux_regress.bed_statistics import weighted_quantile
from granflux_regress.command_line import BAD_INPUT, DIFFERS, EQUAL, main

COLUMNS = "id type x y z vx vy vz omegax omegay omegaz radius c_contacts"
WHOLE = {"id", "type"}


def bed(seed=1, count=50):
    """Rows of a bed of two types in a box of 1 m, by id."""
    random = np.random.default_rng(seed)
    rows = np.empty((count, 13))
    rows[:, 0] = np.arange(1, count + 1)
    rows[:, 1] = 1 + rows[:, 0] % 2
    rows[:, 2:5] = random.uniform(0.05, 0.95, (count, 3))
    rows[:, 5:11] = random.normal(0, 1, (count, 6))
    rows[:, 11] = random.uniform(0.01, 0.02, count)
    rows[:, 12] = random.integers(0, 8, count)
    return rows


def dump_text(rows, step=100, columns=COLUMNS, bounds="ff ff ff", title="ATOMS"):
    names = columns.split()
    lines = [
        f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF {title}\n{len(rows)}",
        f"ITEM: BOX BOUNDS {bounds}\n0 1\n0 1\n0 1\nITEM: {title} {columns} ",
    ]
    for row in rows:
        words = [f"{v:.0f}" if n in WHOLE else f"{v:.17g}" for n, v in zip(names, row)]
        lines.append(" ".join(words))
    return "\n".join(lines) + "\n"


class RegressTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return str(path)

    def regress(self, a, b, *options):
        """(exit code, what it printed) for the texts of two dumps."""
        return self.start(self.write("a.dump", a), self.write("b.dump", b), *options)

    def start(self, *words):
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stderr(errors):
            code = main(words, out)
        return code, out.getvalue() + errors.getvalue()

    def expect(self, code, found, *texts):
        self.assertEqual(found[0], code, found[1])
        for text in texts:
            self.assertIn(text, found[1])


class Particles(RegressTest):
    def test_equal_in_any_order_of_rows_and_columns(self):
        rows = bed()
        names = COLUMNS.split()
        order = names[::-1]
        turned = rows[::-1][:, [names.index(name) for name in order]]
        found = self.regress(dump_text(rows), dump_text(turned, columns=" ".join(order)))
        self.expect(EQUAL, found, "equal: 1 snapshots, 50 rows")

    def test_a_change_of_five_percent_in_one_particle(self):
        for column, quantity in ((2, "x"), (6, "v"), (9, "omega"), (11, "radius")):
            with self.subTest(quantity):
                rows = bed()
                largest = int(np.abs(rows[:, column]).argmax())
                rows[largest, column] *= 1.05
                found = self.regress(dump_text(bed()), dump_text(rows))
                self.expect(DIFFERS, found, f"worst: {quantity} of id {largest + 1} at step 100")

    def test_two_particles_that_changed_places(self):
        rows = bed()
        rows[[6, 30], 2:] = rows[[30, 6], 2:]
        found = self.regress(dump_text(bed()), dump_text(rows), "--verbose")
        self.expect(DIFFERS, found, "x: 2 further than allowed", "v: 2 further than allowed")

    def test_just_inside_and_just_outside_of_the_tolerance(self):
        rows = bed()
        scale = np.linalg.norm(bed()[:, 5:8], axis=1).max()
        rows[4, 6] += 1e-6 * scale
        texts = dump_text(bed()), dump_text(rows)
        self.expect(DIFFERS, self.regress(*texts))
        self.expect(DIFFERS, self.regress(*texts, "--tolerance", "v=0.99e-6"))
        self.expect(EQUAL, self.regress(*texts, "--tolerance", "v=1.01e-6"))
        self.expect(EQUAL, self.regress(*texts, "--tolerance", f"v=0,{1.01e-6 * scale}"))
        self.expect(EQUAL, self.regress(*texts, "--default", "1.01e-6"))
        self.expect(DIFFERS, self.regress(*texts, "--default", "1", "--tolerance", "v=0.99e-6"))

    def test_a_type_is_equal_or_not(self):
        rows = bed()
        rows[3, 1] = 5
        found = self.regress(dump_text(bed()), dump_text(rows), "--default", "10")
        self.expect(DIFFERS, found, "type: 1 further than allowed, worst id 4: 1 -> 5")

    def test_missing_and_extra_particles(self):
        rows = bed()
        found = self.regress(dump_text(rows[:-1]), dump_text(rows[2:]))
        self.expect(DIFFERS, found, "2 missing particles: id 1, id 2", "1 extra particles: id 50")

    def test_missing_columns(self):
        shorter = COLUMNS.replace(" radius c_contacts", "")
        found = self.regress(dump_text(bed()), dump_text(bed()[:, :11], columns=shorter))
        self.expect(DIFFERS, found, "missing columns radius, c_contacts")
        found = self.regress(dump_text(bed()), dump_text(bed()[:, :11], columns=shorter),
                             "--ignore", "radius,c_contacts")
        self.expect(EQUAL, found)

    def test_other_time_steps(self):
        two = dump_text(bed(), 100) + dump_text(bed(), 200)
        found = self.regress(two, dump_text(bed(), 100) + dump_text(bed(), 300))
        self.expect(DIFFERS, found, "step 200: missing snapshot", "step 300: extra snapshot")
        self.expect(EQUAL, self.regress(two, dump_text(bed(), 100), "--step", "100"))
        self.expect(DIFFERS, self.regress(two, dump_text(bed(), 100), "--step", "100,200"))

    def test_a_number_that_is_none_differs(self):
        text = dump_text(bed()).replace(f"{bed()[7, 5]:.17g}", "nan")
        self.expect(DIFFERS, self.regress(dump_text(bed()), text, "--default", "1e3"), "id 8")
        self.expect(DIFFERS, self.regress(text, text, "--default", "1e3"), "id 8")

    def test_positions_by_the_nearest_image(self):
        rows, moved = bed(), bed()
        rows[0, 2:5] = 1e-13, 0.5, 0.5
        moved[0, 2:5] = 1 - 1e-13, 0.5, 0.5
        for bounds, code in (("pp ff ff", EQUAL), ("ff pp pp", DIFFERS)):
            texts = dump_text(rows, bounds=bounds), dump_text(moved, bounds=bounds)
            self.expect(code, self.regress(*texts))

    def test_a_vector_of_ones_own(self):
        columns = "id f_a[1] f_a[2]"
        rows = np.array([[1, 1.0, 1e-3], [2, 1.0, 0.0]])
        other = rows + np.array([[0, 0, 1e-6], [0, 0, 0]])
        texts = dump_text(rows, columns=columns), dump_text(other, columns=columns)
        self.expect(DIFFERS, self.regress(*texts, "--default", "2e-6"), "f_a[2]")
        self.expect(EQUAL, self.regress(*texts, "--default", "2e-6", "--vector", "a=f_a[1],f_a[2]"))

    def test_lines_that_lammps_adds(self):
        text = dump_text(bed())
        self.expect(EQUAL, self.regress("ITEM: UNITS\nsi\nITEM: TIME\n0.5\n" + text, text))

    def test_compressed_dumps(self):
        path = self.folder / "a.dump.gz"
        path.write_bytes(gzip.compress(dump_text(bed()).encode()))
        self.expect(EQUAL, self.start(str(path), self.write("b.dump", dump_text(bed()))))

    def test_no_particles(self):
        self.expect(EQUAL, self.regress(dump_text(bed()[:0]), dump_text(bed()[:0])))


class Contacts(RegressTest):
    COLUMNS = "c_c[1] c_c[2] c_c[3] c_c[4]"
    OPTIONS = ("--key", "c_c[1],c_c[2]", "--odd", "c_c[3]")

    def texts(self, other):
        rows = np.array([[1, 2, 0.5, 3.0], [2, 7, -0.25, 4.0]])
        return [dump_text(np.array(r), columns=self.COLUMNS, title="ENTRIES") for r in (rows, other)]

    def test_partners_may_change_places(self):
        texts = self.texts([[7, 2, 0.25, 4.0], [1, 2, 0.5, 3.0]])
        self.expect(EQUAL, self.regress(*texts, *self.OPTIONS))
        self.expect(DIFFERS, self.regress(*texts, *self.OPTIONS[:2]), "contact 2-7")

    def test_a_contact_that_is_not_there(self):
        found = self.regress(*self.texts([[1, 3, 0.5, 3.0], [2, 7, -0.25, 4.0]]), *self.OPTIONS)
        self.expect(DIFFERS, found, "1 missing contacts: contact 1-2", "1 extra contacts: contact 1-3")


class Statistics(RegressTest):
    OPTIONS = ("--statistics", "--density", "2500")

    def test_closed_form_of_two_spheres(self):
        columns = "id x y z vx vy vz omegax omegay omegaz radius mass"
        rows = np.array([[1, 0, 0, 0.1, 2, 0, 0, 0, 3, 0, 0.5, 1], [2, 0, 0, 0.5, 0, 0, 1, 0, 0, 0, 1, 3]])
        text = dump_text(rows, columns=columns)
        found = self.regress(text, text, "--statistics", "--floor", "-1")
        self.expect(EQUAL, found)
        numbers = {line.split()[0]: float(line.split()[1]) for line in found[1].splitlines()[2:-1]
                   if not line.strip().startswith("centre_of_mass")}
        expected = {"particles": 2, "mass": 4, "kinetic_energy": 0.5 * 4 + 0.5 * 3,
                    "rotational_energy": 0.5 * 0.4 * 0.25 * 9, "mean_height": (1.1 + 3 * 1.5) / 4,
                    "height_95": 1.5}
        self.assertEqual(numbers.keys(), expected.keys())
        for name, value in expected.items():
            self.assertAlmostEqual(numbers[name], value, 7, name)

    def test_weighted_quantile(self):
        self.assertEqual(weighted_quantile(np.array([3.0, 1.0, 2.0]), np.ones(3), 0.5), 2.0)
        self.assertEqual(weighted_quantile(np.array([3.0, 1.0, 2.0]), np.array([98.0, 1.0, 1.0]), 0.95), 3.0)

    def test_permuted_particles_are_the_same_bed(self):
        rows = bed()
        rows[:, 1:] = rows[::-1, 1:]
        self.expect(EQUAL, self.regress(dump_text(bed()), dump_text(rows), *self.OPTIONS))

    def test_a_change_of_five_percent_in_each_statistic(self):
        changes = {"kinetic_energy": (slice(5, 8), 1.06**0.5), "rotational_energy": (slice(8, 11), 1.06**0.5),
                   "mean_height": (4, 1.05), "height_95": (4, 1.05), "coordination_number": (12, 1.06),
                   "mass": (11, 1.05)}
        for name, (columns, factor) in changes.items():
            with self.subTest(name):
                rows = bed()
                rows[:, columns] *= factor
                found = self.regress(dump_text(bed()), dump_text(rows), *self.OPTIONS)
                lines = [line for line in found[1].splitlines() if line.strip().startswith(name)]
                self.expect(DIFFERS, found)
                self.assertTrue(lines[0].endswith("DIFFERENT"), found[1])

    def test_mean_over_snapshots(self):
        up, down = bed(), bed()
        up[:, 5:8] *= 1.2
        down[:, 5:8] *= (2 - 1.44) ** 0.5
        swing = dump_text(up, 100) + dump_text(down, 200)
        steady = dump_text(bed(), 100) + dump_text(bed(), 200)
        self.expect(DIFFERS, self.regress(steady, swing, *self.OPTIONS))
        self.expect(EQUAL, self.regress(steady, swing, *self.OPTIONS, "--average"), "mean of 2")


class BadInput(RegressTest):
    def expect_bad(self, found, *texts):
        self.expect(BAD_INPUT, found, "granflux-regress: ", *texts)

    def test_files(self):
        good = dump_text(bed())
        self.expect_bad(self.start("/nowhere/a.dump", "b.dump"), "/nowhere/a.dump", "No such file")
        self.expect_bad(self.regress("", good), "a.dump: is empty")
        self.expect_bad(self.regress("step 1\n", good), "a.dump, line 1", "ITEM: TIMESTEP")
        self.expect_bad(self.regress(good, good[: len(good) // 2].rsplit("\n", 1)[0] + "\n"),
                        "b.dump", "of the 50 rows of step 100")
        self.expect_bad(self.regress(good, good.replace("ITEM: BOX", "ITEM: FOX")), "line 5", "BOX BOUNDS")
        self.expect_bad(self.regress(good + good, good), "step 100 after step 100")
        path = self.folder / "c.dump.gz"
        path.write_bytes(gzip.compress(good.encode())[:-20])
        self.expect_bad(self.start(str(path), str(path)), "c.dump.gz: cannot be read")

    def test_rows(self):
        good = dump_text(bed())
        lines = good.splitlines()
        lines[12] = " ".join(lines[12].split()[:-1])
        self.expect_bad(self.regress(good, "\n".join(lines) + "\n"), "b.dump, line 13: 12 numbers")
        self.expect_bad(self.regress(good.replace("\n7 2 ", "\n7 Al "), good), "'Al' in column type", "--ignore type")
        rows = bed()
        rows[1, 0] = 1
        self.expect_bad(self.regress(dump_text(rows), good), "id 1 is there more than once")
        no_id = dump_text(bed()[:, 1:], columns=COLUMNS[3:])
        self.expect_bad(self.regress(no_id, no_id), "no column 'id'")

    def test_options(self):
        good = dump_text(bed())
        for options, text in (
            (("--tolerance", "v"), "NAME=RELATIVE"),
            (("--tolerance", "vx=1"), "nothing is called 'vx'; there are x, v, omega"),
            (("--tolerance", "v=-1"), "'-1' is no tolerance"),
            (("--default", "nan"), "'nan' is no tolerance"),
            (("--vector", "a=q"), "no column q"),
            (("--step", "last"), "write time steps"),
            (("--step", "7"), "neither dump"),
            (("--key", "a,b,c"), "--key a,b,c"),
            (("--odd", "x"), "--odd is for contacts"),
            (("--average",), "--average belongs to --statistics"),
            (("--statistics",), "--density"),
            (("--statistics", "--density", "1", "--contacts", "q"), "no column 'q'"),
            (("--fast",), "unrecognized arguments"),
        ):
            with self.subTest(options):
                self.expect_bad(self.regress(good, good, *options), text)


if __name__ == "__main__":
    unittest.main()
