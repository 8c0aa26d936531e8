# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Errors, Pareto front and recommendation on made-up numbers."""

import unittest
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from granflux_study.advice import best_measured, front_of, next_try, sentence
from granflux_study.case import FINEST, Knob, Level, Quantity
from granflux_study.changes import Changes
from granflux_study.errors import Errors
from granflux_study.measured import Measured, Value
from granflux_study.pareto import front
from granflux_study.recommend import guesses
from granflux_study.settings import setting_of


def knob(name, labels, base=None):
    return Knob(name, "", tuple(Level(label, Changes()) for label in labels), base or labels[-1])


def study(knobs, right=None, reference=FINEST):
    quantity = Quantity("q", "", "", "table", "", "", "mean", (0, 1), 1.0, None if right is None else np.array([right]), None, True)
    out = SimpleNamespace(knobs=tuple(knobs), quantities=(quantity,), reference=reference, folder=Path())
    out.base = {k.name: k.base for k in knobs}
    return out


def errors_of(case, runs):
    """`runs`: {(label, ...) of the knobs that are not at their base as a frozenset of items: (cost, value, chance)}."""
    measured = {}
    for turned, (cost, value, chance) in runs.items():
        setting = setting_of(case, dict(turned))
        failure = "" if value is not None else "blew up"
        values = {} if failure else {"q": Value(np.array([value]), np.array([chance]), True)}
        measured[setting] = Measured(setting, failure, cost, cost, 1.0, False, values, (), None)
    return Errors(case, measured)


def at(**levels):
    return tuple(levels.items())


class Front(unittest.TestCase):
    def test_what_nothing_beats(self):
        points = [(4, 1), (1, 4), (2, 2), (3, 2), (2, 5), (5, 0.5), (1, 4)]
        self.assertEqual([points[i] for i in front(points)], [(1, 4), (2, 2), (4, 1), (5, 0.5)])

    def test_one_and_none(self):
        self.assertEqual(front([(1, 1)]), [0])
        self.assertEqual(front([]), [])


class Recommendation(unittest.TestCase):
    def setUp(self):
        self.case = study([knob("a", ["coarse", "fine"]), knob("b", ["wild", "coarse", "fine"])])
        self.runs = {at(): (10.0, 1.0, 0.0), at(a="coarse"): (5.0, 1.03, 0.0), at(b="coarse"): (2.0, 0.96, 0.0),
                     at(b="wild"): (0.1, None, 0.0)}

    def guesses(self, wanted):
        return guesses(self.case, errors_of(self.case, self.runs), wanted)

    def test_costs_multiply_and_errors_add_whichever_way_they_go(self):
        best = self.guesses(0.08)[0]
        self.assertEqual(best.setting, setting_of(self.case, {"a": "coarse", "b": "coarse"}))
        self.assertAlmostEqual(best.cost, 1.0)
        self.assertAlmostEqual(best.error, 0.07)  # not 0.01: one is not counted on to hide the other
        self.assertEqual(self.guesses(0.05)[0].setting, setting_of(self.case, {"b": "coarse"}))
        self.assertEqual(self.guesses(0.02)[0].setting, setting_of(self.case, {}))

    def test_a_combination_is_tried_until_one_that_was_run_keeps_the_error(self):
        errors = errors_of(self.case, self.runs)
        both = setting_of(self.case, {"a": "coarse", "b": "coarse"})
        self.assertEqual(next_try(self.case, errors, list(errors.measured), 0.08), both)
        self.runs[at(a="coarse", b="coarse")] = (1.2, 1.09, 0.0)  # worse than foreseen
        errors = errors_of(self.case, self.runs)
        self.assertIsNone(next_try(self.case, errors, list(errors.measured), 0.08))
        self.assertEqual(best_measured(errors, list(errors.measured), 0.08), setting_of(self.case, {"b": "coarse"}))
        self.runs[at(a="coarse", b="coarse")] = (1.25, 1.06, 0.0)
        errors = errors_of(self.case, self.runs)
        self.assertEqual(sentence(self.case, errors, list(errors.measured), 0.08),
                         "error 8 %: a coarse, b coarse: 8 times faster than the base, every knob at its finest, error 6 % (q)")

    def test_the_front_leaves_out_what_failed(self):
        errors = errors_of(self.case, self.runs)
        self.assertEqual(front_of(errors, list(errors.measured)),
                         [setting_of(self.case, t) for t in ({"b": "coarse"}, {"a": "coarse"}, {})])

    def test_finer_levels_take_their_share_off(self):
        case = study([knob("a", ["coarse", "fine"], "coarse"), knob("b", ["coarse", "fine"], "coarse")], right=1.0)
        errors = errors_of(case, {at(): (1.0, 1.2, 0.0), at(a="fine"): (2.0, 1.1, 0.0), at(b="fine"): (3.0, 1.05, 0.0)})
        best = guesses(case, errors, 0.03)[0]
        self.assertEqual(best.setting, setting_of(case, {"a": "fine", "b": "fine"}))
        self.assertAlmostEqual(best.error, 0.025)
        self.assertAlmostEqual(best.cost, 6.0)


class Chance(unittest.TestCase):
    def test_a_difference_within_chance_is_no_error(self):
        case = study([knob("a", ["coarse", "fine"])])
        errors = errors_of(case, {at(): (10.0, 1.0, 0.03), at(a="coarse"): (1.0, 1.04, 0.04)})
        error = errors.of(setting_of(case, {"a": "coarse"}), case.quantities[0])
        self.assertAlmostEqual(error.size, 0.04)
        self.assertAlmostEqual(error.chance, 0.05)
        self.assertFalse(error.told)
        self.assertAlmostEqual(error.bound, 0.10)
        self.assertIn("nothing beyond chance", error.words())
        # It cannot be recommended for 5 %, though 4 % was seen; for 10 % it can.
        self.assertEqual(best_measured(errors, list(errors.measured), 0.05), setting_of(case, {}))
        self.assertEqual(best_measured(errors, list(errors.measured), 0.101), setting_of(case, {"a": "coarse"}))

    def test_a_run_has_no_difference_from_itself(self):
        case = study([knob("a", ["coarse", "fine"])])
        errors = errors_of(case, {at(): (10.0, 1.0, 0.03), at(a="coarse"): (1.0, 1.04, 0.04)})
        error = errors.of(setting_of(case, {}), case.quantities[0])
        self.assertEqual((error.size, error.chance), (0.0, 0.0))


class Reference(unittest.TestCase):
    def test_against_the_finest_of_each_knob(self):
        """Right is base + sum (finest - base); for one knob alone, its finest."""
        case = study([knob("a", ["coarse", "fine"], "coarse"), knob("b", ["coarse", "fine"], "coarse")])
        errors = errors_of(case, {at(): (1.0, 1.2, 0.0), at(a="fine"): (2.0, 1.1, 0.0), at(b="fine"): (3.0, 1.05, 0.0)})
        base, quantity = setting_of(case, {}), case.quantities[0]
        right = 1.2 - 0.1 - 0.15
        self.assertAlmostEqual(errors.of(base, quantity).size, (1.2 - right) / right)
        self.assertAlmostEqual(errors.of(base, quantity, [case.knobs[0]]).size, 0.1 / right)
        self.assertEqual(errors.of(setting_of(case, {"a": "fine"}), quantity, [case.knobs[0]]).size, 0.0)

    def test_against_a_named_run(self):
        case = study([knob("a", ["coarse", "fine"], "coarse")], reference={"a": "fine"})
        errors = errors_of(case, {at(): (1.0, 1.2, 0.0), at(a="fine"): (2.0, 1.0, 0.0)})
        self.assertAlmostEqual(errors.of(setting_of(case, {}), case.quantities[0]).size, 0.2)


if __name__ == "__main__":
    unittest.main()
