# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""How far two values may lie apart."""

from dataclasses import dataclass

from granflux_regress.bad_input import BadInput


@dataclass(frozen=True)
class Tolerance:
    relative: float
    absolute: float = 0.0

    def allowed(self, scale):
        return self.absolute + self.relative * scale


def parse_tolerance(text, what):
    """A tolerance from 'rel' or 'rel,abs'; `what` names it in the message."""
    try:
        numbers = [float(word) for word in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (1, 2) or not all(0 <= number < float("inf") for number in numbers):
        raise BadInput(f"{what}: '{text}' is no tolerance; allowed: RELATIVE or "
                       "RELATIVE,ABSOLUTE, both zero or greater")
    return Tolerance(*numbers)


def parse_named(texts, option, known):
    """{name: tolerance} from texts 'name=rel[,abs]'; every name must be one of `known`."""
    named = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals:
            raise BadInput(f"{option} {text}: write NAME=RELATIVE[,ABSOLUTE]")
        if name not in known:
            raise BadInput(f"{option} {text}: nothing is called '{name}'; there are {', '.join(known)}")
        named[name] = parse_tolerance(value, f"{option} {name}")
    return named
