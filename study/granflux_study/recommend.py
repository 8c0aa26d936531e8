# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The quickest setting for a wanted error: guessed from one knob at a time, then run."""

import itertools
import math
from dataclasses import dataclass

from granflux_study.bad_input import BadInput
from granflux_study.settings import setting_of

TRIES = 6  # combinations that are run for one wanted error
GAIN = 0.97  # of the cost: what gains less is not worth leaving the base for, and may be chance
MOST = 1_000_000  # combinations that are looked at


@dataclass(frozen=True)
class Guess:
    """Expected cost, s of processor time for each simulated second, and relative error of a setting."""

    cost: float
    error: float
    setting: object


@dataclass(frozen=True)
class Choice:
    """What a level does to the base: cost and error times a factor, and what it adds to the error."""

    cost: float
    left: float
    added: float
    label: str

    def beaten_by(self, other):
        mine, its = (self.cost, self.left, self.added), (other.cost, other.left, other.added)
        return its != mine and all(b <= a for a, b in zip(mine, its))


def guesses(study, errors, wanted, names=()):
    """Guesses of the combinations of levels that should keep the wanted error, the quickest first.

    Costs multiply: each level changes the base's cost by the factor it was seen to. A level coarser than
    the base adds to the error what it moves the quantity, whichever way, so that no error is counted on to
    hide another; a finer one takes the share of the base's error off that it was seen to. Differences
    within chance do not count. Levels that failed are left out.
    """
    base = setting_of(study, {})
    choices = [_choices(study, errors, knob, base, names) for knob in study.knobs]
    if (count := math.prod(map(len, choices))) > MOST:
        raise BadInput(f"{count} combinations of levels; {MOST} can be looked at: take knobs or levels out")
    cost, error = errors.measured[base].cost, _told(errors.worst(base, names)[0])
    found = []
    for levels in itertools.product(*choices):
        guess = error * math.prod(c.left for c in levels) + sum(c.added for c in levels)
        if guess <= wanted:
            found.append((cost * math.prod(c.cost for c in levels), guess, [c.label for c in levels]))
    return [Guess(cost, error, setting_of(study, {k.name: label for k, label in zip(study.knobs, labels)}))
            for cost, error, labels in sorted(found)]


def _told(error):
    return error.size if error.told else 0.0


def _choices(study, errors, knob, base, names):
    """The levels of a knob that came to its end and that no other one beats in everything."""
    cost, error = errors.measured[base].cost, _told(errors.worst(base, names)[0])
    out, finer = [Choice(1.0, 1.0, 0.0, knob.base)], False
    for level in knob.levels:
        setting = setting_of(study, {knob.name: level.label})
        if level.label == knob.base:
            finer = True
        elif not errors.measured[setting].failure:
            factor, left, added = errors.measured[setting].cost / cost, 1.0, 0.0
            if finer and error > 0.0:
                left = _told(errors.worst(setting, names)[0]) / error
            else:
                added = max(_told(errors.between(setting, base, q)) for q in errors.judged(names))
            surely = factor * errors.measured[setting].spread < 1.0  # its slowest run is quicker than the base's quickest
            if (factor < GAIN and surely) or left < 1.0:
                out.append(Choice(factor, left, added, level.label))
    return [a for a in out if not any(a.beaten_by(b) for b in out)]
