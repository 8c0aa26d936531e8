# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the runs of a setting gave: quantities with their statistical errors, and what they cost."""

from dataclasses import dataclass

import numpy as np

from granflux_study.bad_input import BadInput
from granflux_study.block_average import error_of_mean
from granflux_study.outputs import read_series

RESOLUTION = 0.1  # of the time of a start-up, below which the cost of a run cannot be told


@dataclass(frozen=True)
class Value:
    """A number, or a profile of m numbers, and its standard error (0 where nothing is random)."""

    value: np.ndarray  # (m,)
    error: np.ndarray  # (m,)
    trusted: bool  # the window is long enough to tell the error


@dataclass(frozen=True)
class Measured:
    """`cost` and `wall` in s for each simulated second: the least of all runs, less the start-up."""

    setting: object
    failure: str  # empty, or why there are no values
    cost: float
    wall: float
    spread: float  # of the cost between runs: largest over least
    at_most: bool  # the run hardly takes longer than its start-up: `cost` is an upper bound
    values: dict  # {quantity: Value}
    versions: tuple
    folder: object


def measured(study, runs, setting, startup):
    """Measured of a setting all of whose runs are there; `startup`: processor and wall time to take off, s."""
    found = runs.records(setting)
    folder, first = found[0]
    records = [record for _, record in found]
    failure = next((record.failure for record in records if record.failure), "")
    values = {}
    if not failure:
        try:
            values = {q.name: value_of(q, folder, study) for q in study.quantities}
        except ArithmeticError as problem:
            failure = str(problem)
    # What a start-up takes is not known better than to a tenth: no run is called quicker than that.
    least = RESOLUTION * startup[0]
    times = [max(record.processor_time - startup[0], least) for record in records]
    walls = [max(record.wall_time - startup[1], RESOLUTION * startup[1]) for record in records]
    return Measured(setting, failure, min(times) / study.simulated_time, min(walls) / study.simulated_time,
                    max(times) / min(times), min(times) == least and startup[0] > 0.0, values,
                    tuple(sorted({record.version for record in records})), folder)


def value_of(quantity, folder, study):
    """The Value of a quantity in the folder of a run. ArithmeticError: what the run wrote is not a number."""
    times, series = read_series(folder / quantity.file, quantity, study.simulated_time)
    if not np.all(np.isfinite(series)):
        raise ArithmeticError(f'{quantity.name} is {series[~np.isfinite(series)][0]}')
    if quantity.how == "final":
        series = series[-1:]
    else:
        series = series[(times >= quantity.window[0]) & (times <= quantity.window[1])]
        if not len(series):
            raise BadInput(f'quantity "{quantity.name}": nothing from {quantity.window[0]:g} to {quantity.window[1]:g} s '
                           f"in {folder / quantity.file}, which goes from {times[0]:g} to {times[-1]:g} s")
    mean = series.mean(axis=0)
    if not study.chaotic:
        return Value(mean, np.zeros_like(mean), True)
    errors = [error_of_mean(column) for column in series.T]
    return Value(mean, np.array([error for error, _ in errors]), all(trusted for _, trusted in errors))
