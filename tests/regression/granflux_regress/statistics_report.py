# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Statistics of two dumps side by side, as text."""

import numpy as np

from granflux_regress.bad_input import BadInput
from granflux_regress.bed_statistics import compare_statistics, extent_of, floor_of, statistics_of


def report(pairs, options, tolerances, average, missing_steps, out):
    """Prints a table for each pair of snapshots, or one of their means; returns whether all agree."""
    results = []  # (step, statistics of a, of b, extent)
    for a, b in pairs:
        floor = floor_of(a, options)
        results.append((a.step, statistics_of(a, options, floor), statistics_of(b, options, floor),
                        extent_of(a)))
    for message in missing_steps:
        print(message, file=out)
    if average and results:
        results = [_mean(results)]
    equal = not missing_steps
    for step, a, b, extent in results:
        print(f"step {step}", file=out)
        print(f"  {'':<20}{'reference':>16}{'dump':>16}{'difference':>14}{'allowed':>12}", file=out)
        for d in compare_statistics(step, a, b, extent, tolerances):
            equal = equal and not d.failed
            for k, (reference, value) in enumerate(zip(d.reference, d.value)):
                name = d.quantity if len(d.reference) == 1 else f"{d.quantity} {'xyz'[k]}"
                end = f"{d.distance:14.4g}{d.allowed:12.4g}{'  DIFFERENT' if d.failed else ''}"
                print(f"  {name:<20}{reference:16.8g}{value:16.8g}{end if k == 0 else ''}", file=out)
    print("equal within tolerance" if equal else "DIFFERENT", file=out)
    return equal


def _mean(results):
    for side in (1, 2):
        if any(result[side].keys() != results[0][side].keys() for result in results):
            raise BadInput("--average: the snapshots do not all have the same columns or particles")
    steps, a, b, extents = zip(*results)
    mean = [{name: np.mean([one[name] for one in side], axis=0) for name in side[0]} for side in (a, b)]
    return f"{steps[0]} to {steps[-1]}, mean of {len(steps)}", *mean, float(np.mean(extents))
