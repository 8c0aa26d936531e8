# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Two snapshots, particle by particle."""

from dataclasses import dataclass

import numpy as np

from granflux_regress.bad_input import BadInput
from granflux_regress.quantities import quantities_of
from granflux_regress.tolerance import Tolerance, parse_named

KEY_BITS = 31  # of each of the two ids of a contact


@dataclass
class Difference:
    """The row of one quantity that lies furthest from its reference."""

    step: int
    quantity: str
    row: str  # the particle, or the two of a contact
    distance: float  # |b - a|, in the unit of the column
    scale: float  # largest |a| of the snapshot, same unit
    allowed: float  # tolerance, same unit
    reference: np.ndarray  # a of that row
    value: np.ndarray  # b of that row
    count: int  # rows that are further than allowed

    @property
    def failed(self):
        return self.count > 0

    @property
    def relative(self):
        if self.distance == 0:
            return 0.0
        return self.distance / self.scale if self.scale > 0 else float("inf")

    @property
    def excess(self):
        """Distance in units of what is allowed."""
        if not self.failed and self.allowed == 0:
            return 0.0
        return self.distance / self.allowed if self.allowed > 0 else float("inf")


@dataclass(frozen=True)
class Keys:
    """What names a row: the particle's id, or the ids of both partners of a contact. Columns in
    `odd` change sign where the partners change places."""

    columns: tuple = ("id",)
    odd: tuple = ()


class Comparison:
    """Options of a comparison; compares snapshot by snapshot and keeps what it found."""

    def __init__(self, default=Tolerance(1e-10), tolerances=(), vectors=None, keys=Keys()):
        self.default, self.texts, self.keys = default, list(tolerances), keys
        self.vectors = vectors or {}
        self.messages = []  # of rows, columns or steps that only one of the dumps has
        self.differences = []  # one for each quantity and snapshot
        self.rows = 0

    @property
    def equal(self):
        return not self.messages and not any(d.failed for d in self.differences)

    def add(self, a, b):
        common = self._common_columns(a, b)
        keys_a, a = keyed(a, self.keys)
        keys_b, b = keyed(b, self.keys)
        self._report_missing(np.setdiff1d(keys_a, keys_b), a.step, "missing")
        self._report_missing(np.setdiff1d(keys_b, keys_a), a.step, "extra")
        both, rows_a, rows_b = np.intersect1d(keys_a, keys_b, assume_unique=True, return_indices=True)
        self.rows += len(both)
        found = quantities_of([c for c in common if c not in self.keys.columns], self.vectors)
        tolerances = parse_named(self.texts, "--tolerance", [q.name for q in found])
        for quantity in found:
            exact = Tolerance(0.0) if quantity.is_exact else self.default
            reference = a.block(quantity.columns)[rows_a]
            value = b.block(quantity.columns)[rows_b]
            distance = _distance(quantity, reference, value, a)
            self.differences.append(_largest(
                a.step, quantity, tolerances.get(quantity.name, exact), both, reference, value,
                distance, self.keys))

    def _common_columns(self, a, b):
        for one, other, word in ((a, b, "missing"), (b, a, "extra")):
            only = [column for column in one.columns if column not in other.columns]
            if only:
                self.messages.append(f"step {a.step}: {word} columns {', '.join(only)}")
        return [column for column in a.columns if column in b.columns]

    def _report_missing(self, rows, step, word):
        if len(rows):
            shown = ", ".join(row_name(row, self.keys) for row in rows[:5])
            more = f" and {len(rows) - 5} more" if len(rows) > 5 else ""
            kind = "particles" if len(self.keys.columns) == 1 else "contacts"
            self.messages.append(f"step {step}: {len(rows)} {word} {kind}: {shown}{more}")


def keyed(snapshot, keys):
    """(keys of the rows, snapshot with the odd columns of contacts that were turned round)."""
    for column in (*keys.columns, *keys.odd):
        if column not in snapshot.columns:
            raise BadInput(f"step {snapshot.step}: no column '{column}' to tell rows by; there are "
                           f"{', '.join(snapshot.columns)} (options --key and --odd)")
    ids = snapshot.block(keys.columns).astype(np.int64)
    if len(keys.columns) == 1:
        key = ids[:, 0]
    else:
        turned = ids[:, 0] > ids[:, 1]
        snapshot.values[np.ix_(turned, [snapshot.columns.index(c) for c in keys.odd])] *= -1
        key = (ids.min(axis=1) << KEY_BITS) | ids.max(axis=1)
    unique, counts = np.unique(key, return_counts=True)
    if len(unique) < len(key):
        twice = row_name(unique[counts > 1][0], keys)
        raise BadInput(f"step {snapshot.step}: {twice} is there more than once "
                       f"(columns {', '.join(keys.columns)})")
    return key, snapshot


def row_name(key, keys):
    if len(keys.columns) == 1:
        return f"{keys.columns[0]} {key}"
    return f"contact {key >> KEY_BITS}-{key & ((1 << KEY_BITS) - 1)}"


def _distance(quantity, reference, value, snapshot):
    """Euclidean distance, (rows); positions by the nearest image in a periodic direction."""
    # both infinite, or one not a number: nan here, which no tolerance passes
    with np.errstate(invalid="ignore"):
        difference = value - reference
    periods = {"x": snapshot.high - snapshot.low, "xs": np.ones(3)}.get(quantity.name)
    if periods is not None:
        for axis in np.flatnonzero(snapshot.periodic):
            difference[:, axis] -= periods[axis] * np.round(difference[:, axis] / periods[axis])
    return np.sqrt((difference**2).sum(axis=1))


def _largest(step, quantity, tolerance, keys, reference, value, distance, key_columns):
    if not len(keys):
        empty = np.zeros(len(quantity.columns))
        return Difference(step, quantity.name, "no row", 0.0, 0.0, 0.0, empty, empty, 0)
    size = np.sqrt((reference**2).sum(axis=1))
    scale = float(size[np.isfinite(size)].max(initial=0.0))
    allowed = tolerance.allowed(scale)
    distance = np.where(np.isnan(distance), np.inf, distance)
    worst = int(distance.argmax())
    return Difference(step, quantity.name, row_name(keys[worst], key_columns),
                      float(distance[worst]), scale, allowed, reference[worst], value[worst],
                      int((distance > allowed).sum()))
