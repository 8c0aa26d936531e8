# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What is recommended for a wanted error, in a sentence."""

from granflux_study.case import FINEST
from granflux_study.errors import percent
from granflux_study.pareto import front
from granflux_study.recommend import GAIN, guesses
from granflux_study.settings import named, setting_of, turned


def best_measured(errors, settings, wanted, names=()):
    """The quickest setting that was run and keeps the wanted error; None where there is none."""
    good = [s for s in settings if not errors.measured[s].failure and errors.worst(s, names)[0].bound <= wanted]
    return min(good, key=lambda s: errors.measured[s].cost, default=None)


def next_try(study, errors, settings, wanted, names=()):
    """The quickest combination that should keep the wanted error, is not run yet, promises to be quicker than
    the best that is, and is not a neighbour of a combination that failed; None where there is none."""
    measured = errors.measured
    best = best_measured(errors, settings, wanted, names)
    if best and measured[best].at_most:
        return None  # quicker cannot be told
    limit = GAIN * measured[best].cost if best else float("inf")
    failed = [s for s in settings if measured[s].failure]

    def promising(guess):
        return guess.cost < limit and not any(_apart(guess.setting, f) <= 1 for f in failed if len(turned(study, f)) > 1)

    return next((g.setting for g in guesses(study, errors, wanted, names)
                 if g.setting not in measured and promising(g)), None)


def _apart(setting, other):
    """In how many knobs two settings differ."""
    return sum(a != b for a, b in zip(setting.labels, other.labels))


def sentence(study, errors, settings, wanted, names=()):
    best = best_measured(errors, settings, wanted, names)
    start = f"error {percent(wanted)} %: "
    if best is None:
        base = setting_of(study, {})
        error, quantity = errors.worst(base, names)
        return (start + f"no setting that was run keeps it; the base has {error.words()} in {quantity.name}"
                + ("" if error.told or error.chance == 0 else ": a longer window would tell more"))
    error, quantity = errors.worst(best, names)
    setting, cost = best, errors.measured[best].cost
    other, label = reference_cost(study, errors)
    ratio = other / cost
    speed = f"{ratio:.2g} times faster than {label}" if ratio >= 1.05 else f"no faster than {label}"
    return start + f"{named(study, setting)}: {speed}, error {error.words()} ({quantity.name})"


def reference_cost(study, errors):
    if study.reference == FINEST or all(q.right is not None for q in study.quantities):
        finest = all(knob.base == knob.finest for knob in study.knobs)
        return errors.measured[setting_of(study, {})].cost, "the base, every knob at its finest" if finest else "the base"
    return errors.measured[setting_of(study, study.reference)].cost, "the reference"


def front_of(errors, settings):
    """The settings on the Pareto front of cost and largest error, the quickest first."""
    good = [s for s in settings if not errors.measured[s].failure]
    points = [(errors.measured[s].cost, errors.worst(s)[0].bound) for s in good]
    return [good[i] for i in front(points)]
