# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Errors of a setting: distance from what is right, and how much of it is chance."""

from dataclasses import dataclass

import numpy as np

from granflux_study.bad_input import BadInput
from granflux_study.case import FINEST
from granflux_study.settings import setting_of

CERTAIN = 2.0  # standard errors that a difference must exceed to be called an error


@dataclass(frozen=True)
class Error:
    """Relative: `size` is the distance found, `chance` its standard error."""

    size: float
    chance: float

    @property
    def told(self):
        """Whether the distance is more than chance."""
        return self.size > CERTAIN * self.chance

    @property
    def bound(self):
        """What the error does not exceed, as far as the runs can tell."""
        return self.size if self.told else CERTAIN * self.chance

    def words(self):
        if self.chance == 0.0:
            return f"{percent(self.size)} %"
        if self.told:
            return f"{percent(self.size)} % ± {percent(self.chance)} %"
        return f"< {percent(self.bound)} % (nothing beyond chance)"


def percent(share):
    return f"{100 * share:.2g}" if share < 0.995 else f"{100 * share:.0f}"


class Errors:
    """Errors of what was `measured` {setting: Measured} in a study."""

    def __init__(self, study, measured):
        self.study, self.measured = study, measured

    def right_settings(self, knobs):
        """{setting: coefficient}: what is right as a sum over runs, when `knobs` are what may be wrong.

        Against the finest level of each knob, every other at its base: base + sum (finest - base).
        """
        if self.study.reference != FINEST:
            return {setting_of(self.study, self.study.reference): 1.0}
        base = setting_of(self.study, {})
        out = {base: 1.0}
        for knob in knobs:
            finest = setting_of(self.study, {knob.name: knob.finest})
            if finest != base:
                out[finest] = out.get(finest, 0.0) + 1.0
                out[base] -= 1.0
        return {setting: c for setting, c in out.items() if c}

    def of(self, setting, quantity, knobs=None):
        """The Error of a quantity; against the finest level of `knobs` only (default: of all)."""
        right = self._right(quantity, self.study.knobs if knobs is None else knobs)
        coefficients = {s: -c for s, c in right.items()}
        coefficients[setting] = coefficients.get(setting, 0.0) + 1.0
        return self._distance(coefficients, quantity, quantity.right)

    def between(self, setting, other, quantity):
        """The difference of two runs as an Error."""
        return self._distance({setting: 1.0, other: -1.0} if setting != other else {}, quantity, None)

    def worst(self, setting, names=()):
        """The Error of largest bound of the quantities that are judged (or of those named), and its quantity."""
        return max(((self.of(setting, q), q) for q in self.judged(names)), key=lambda pair: pair[0].bound)

    def judged(self, names=()):
        return [q for q in self.study.quantities if (q.name in names if names else q.judged)]

    def _right(self, quantity, knobs):
        return {} if quantity.right is not None else self.right_settings(knobs)

    def _values(self, setting, quantity):
        return self.measured[setting].values[quantity.name]

    def _scale(self, quantity):
        if quantity.scale is not None:
            return quantity.scale
        right = quantity.right
        if right is None:
            right = sum(c * self._values(s, quantity).value for s, c in self.right_settings(self.study.knobs).items())
        if not np.any(right):
            raise BadInput(f'quantity "{quantity.name}" scale: missing; what is right is 0, and errors relative to it need one')
        return _rms(right)

    def _distance(self, coefficients, quantity, right):
        """Root mean square of sum c value - right, and of its standard error, over the scale."""
        values = [(c, self._values(s, quantity)) for s, c in coefficients.items() if c]
        lengths = {len(v.value) for _, v in values} | ({len(right)} if right is not None else set())
        if len(lengths) > 1:
            raise BadInput(f'quantity "{quantity.name}": profiles of {" and ".join(map(str, sorted(lengths)))} numbers; '
                           "what is compared must have the same")
        if not values:
            return Error(0.0, 0.0)
        difference = sum(c * v.value for c, v in values) - (0.0 if right is None else right)
        variance = sum((c * v.error) ** 2 for c, v in values)
        scale = self._scale(quantity)
        return Error(_rms(difference) / scale, float(np.sqrt(np.mean(variance))) / scale)


def _rms(values):
    return float(np.sqrt(np.mean(np.square(values))))
