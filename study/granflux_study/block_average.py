# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Statistical error of the mean of a correlated series, by block averages.

H. Flyvbjerg, H. G. Petersen, J. Chem. Phys. 91 (1989) 461-466.
"""

import math

import numpy as np

LEAST_BLOCKS = 6  # with fewer, the scatter of the means says little


def error_of_mean(series):
    """Standard error of the mean of a series (n,), and whether it can be trusted.

    Neighbours are averaged pair by pair again and again. The estimate from the means of blocks grows with
    the length of the blocks until they no longer know of each other; the first estimate that no later one,
    of two at least, exceeds by more than its own uncertainty is taken. Where there is none, the window is
    too short: the largest estimate is returned, and False.
    """
    series = np.asarray(series, float)
    estimates, uncertainties = [], []
    while len(series) >= LEAST_BLOCKS or (not estimates and len(series) > 1):
        n = len(series)
        estimate = float(np.std(series, ddof=1) / math.sqrt(n))
        estimates.append(estimate)
        uncertainties.append(estimate / math.sqrt(2 * (n - 1)))
        series = 0.5 * (series[0 : n - n % 2 : 2] + series[1::2])
    for at, estimate in enumerate(estimates[:-2]):
        if all(e <= estimate + u for e, u in zip(estimates[at + 1 :], uncertainties[at + 1 :])):
            return estimate, True
    return max(estimates, default=0.0), False
