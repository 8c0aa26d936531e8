# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A TOML table whose keys are asked for one by one, so that a wrong or unknown one is an error."""

import difflib
import math

from granflux_study.bad_input import BadInput

REQUIRED = object()


class CheckedTable:
    """`where` names the table in messages, such as "study.toml: [[knob]] 2"."""

    def __init__(self, values, where):
        if not isinstance(values, dict):
            raise BadInput(f"{where}: must be a table, not {values!r}")
        self.values, self.where, self.asked = values, where, []

    def __contains__(self, key):
        self.asked.append(key)
        return key in self.values

    def refuse(self, key, allowed):
        raise BadInput(f"{self.where} {key} = {self.values.get(key)!r}: must be {allowed}")

    def get(self, key, right, allowed, default=REQUIRED):
        """The value of `key`, for which right(value) must hold; `allowed` says so in words."""
        self.asked.append(key)
        if key not in self.values:
            if default is REQUIRED:
                raise BadInput(f"{self.where} {key}: missing; must be {allowed}")
            return default
        if not right(self.values[key]):
            self.refuse(key, allowed)
        return self.values[key]

    def text(self, key, default=REQUIRED):
        return self.get(key, lambda v: isinstance(v, str) and v != "", "a text", default)

    def words(self, key, default=REQUIRED, least=0):
        def right(v):
            return isinstance(v, list) and len(v) >= least and all(isinstance(w, str) and w for w in v)

        return self.get(key, right, f"a list of {'one text or more' if least else 'texts'}", default)

    def flag(self, key, default=REQUIRED):
        return self.get(key, lambda v: isinstance(v, bool), "true or false", default)

    def number(self, key, default=REQUIRED, above=-math.inf):
        def right(v):
            return isinstance(v, (int, float)) and not isinstance(v, bool) and math.isfinite(v) and v > above

        allowed = "a number" if above == -math.inf else f"a number > {above:g}"
        return self.get(key, right, allowed, default)

    def whole(self, key, default, least):
        def right(v):
            return isinstance(v, int) and not isinstance(v, bool) and v >= least

        return self.get(key, right, f"a whole number >= {least}", default)

    def choice(self, key, choices, default=REQUIRED):
        return self.get(key, lambda v: v in choices, "one of " + ", ".join(f'"{c}"' for c in choices), default)

    def table(self, key):
        """The table of that name; an empty one where there is none."""
        return CheckedTable(self.get(key, lambda v: isinstance(v, dict), "a table", {}), f"{self.where} {key}")

    def tables(self, key, least=0):
        def right(v):
            return isinstance(v, list) and len(v) >= least and all(isinstance(t, dict) for t in v)

        found = self.get(key, right, f"{least} or more tables", REQUIRED if least else [])
        return [CheckedTable(t, f"{self.where} [[{key}]] {n}") for n, t in enumerate(found, 1)]

    def close(self):
        """To be called when all keys have been asked for."""
        for key in self.values:
            if key not in self.asked:
                near = difflib.get_close_matches(key, self.asked, 1)
                raise BadInput(f"{self.where} {key}: unknown key; " + (
                    f"did you mean {near[0]}?" if near else "there are " + ", ".join(self.asked)))
