# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Statistical errors against closed forms: white noise, and series whose neighbours know of each other."""

import math
import unittest

import numpy as np

from granflux_study.block_average import error_of_mean


def autoregressive(memory, length, random):
    """x_n = memory x_(n-1) + noise, in its steady state, of variance 1."""
    noise = random.standard_normal(length) * math.sqrt(1 - memory**2)
    out = np.empty(length)
    out[0] = random.standard_normal()
    for n in range(1, length):
        out[n] = memory * out[n - 1] + noise[n]
    return out


def exact(memory, length):
    """Standard error of the mean of `length` values of that series."""
    k = np.arange(1, length)
    return math.sqrt((1 + 2 * np.sum((1 - k / length) * memory**k)) / length)


class BlockAverage(unittest.TestCase):
    def test_against_the_closed_form(self):
        random = np.random.default_rng(1)
        for memory in (0.0, 0.5, 0.9):
            found = [error_of_mean(autoregressive(memory, 4096, random)) for _ in range(60)]
            mean = np.mean([error for error, _ in found])
            self.assertAlmostEqual(mean / exact(memory, 4096), 1.0, delta=0.06, msg=f"memory {memory}")
            self.assertGreater(sum(trusted for _, trusted in found), 40)

    def test_blocks_are_what_makes_it_right(self):
        series = autoregressive(0.9, 4096, np.random.default_rng(2))
        naive = np.std(series, ddof=1) / math.sqrt(len(series))
        self.assertLess(naive, 0.3 * exact(0.9, 4096))
        self.assertGreater(error_of_mean(series)[0], 0.7 * exact(0.9, 4096))

    def test_a_window_that_is_too_short_says_so(self):
        random = np.random.default_rng(3)
        trusted = [error_of_mean(autoregressive(0.999, 400, random))[1] for _ in range(20)]
        self.assertLess(sum(trusted), 5)
        self.assertEqual(error_of_mean([1.0, 2.0, 4.0])[1], False)

    def test_what_does_not_vary_has_no_error(self):
        self.assertEqual(error_of_mean(np.full(64, 3.0)), (0.0, True))
        self.assertEqual(error_of_mean([3.0]), (0.0, False))


if __name__ == "__main__":
    unittest.main()
