# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads text dumps: styles custom (ITEM: ATOMS) and local (ITEM: ENTRIES), plain or gzip."""

import gzip
import itertools
import warnings
from dataclasses import dataclass

import numpy as np

from granflux_regress.bad_input import BadInput


@dataclass
class Snapshot:
    step: int
    columns: list  # names, in the order of the file, without those ignored
    values: np.ndarray  # (rows, columns)
    low: np.ndarray  # (3) lower corner of the box
    high: np.ndarray  # (3) upper corner
    periodic: tuple  # (3) whether the box is periodic in x, y, z

    def column(self, name):
        return self.values[:, self.columns.index(name)]

    def block(self, names):
        """Columns side by side: (rows, len(names))."""
        return self.values[:, [self.columns.index(name) for name in names]]


def read_dump(path, ignored=(), steps=None):
    """Yields the snapshots of a file, in its order; only those of `steps` where given."""
    open_text = gzip.open if str(path).endswith(".gz") else open
    try:
        with open_text(path, "rt", encoding="ascii") as file:
            yield from _snapshots(_Lines(file, path), set(ignored), steps)
    except (OSError, EOFError, UnicodeDecodeError, gzip.zlib.error) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        raise BadInput(f"{path}: cannot be read: {reason}") from problem


class _Lines:
    """Lines with their number, for messages."""

    def __init__(self, file, path):
        self.file, self.path, self.number = file, path, 0

    def next(self):
        self.number += 1
        return self.file.readline()

    def many(self, count):
        self.number += count
        return list(itertools.islice(self.file, count))

    def bad(self, text):
        return BadInput(f"{self.path}, line {self.number}: {text}")

    def expect(self, title):
        line = self.next()
        if not line.startswith(title):
            raise self.bad(f"'{line.strip()}' where '{title}' should stand; only text dumps of "
                           "style custom or local can be compared")
        return line[len(title):].split()

    def number_below(self, title):
        self.expect(title)
        line = self.next()
        try:
            return int(line)
        except ValueError:
            raise self.bad(f"'{line.strip()}' is no whole number ({title})") from None


def _snapshots(lines, ignored, steps):
    last_step = None
    while first := lines.next():
        if not first.strip():
            continue
        if first.strip() in ("ITEM: UNITS", "ITEM: TIME"):  # of LAMMPS' dump_modify units, time
            lines.next()
            continue
        if not first.startswith("ITEM: TIMESTEP"):
            raise lines.bad(f"'{first.strip()[:60]}' where 'ITEM: TIMESTEP' should stand")
        line = lines.next()
        if not line.strip().isdigit():
            raise lines.bad(f"'{line.strip()}' is no time step")
        step = int(line)
        if last_step is not None and step <= last_step:
            raise lines.bad(f"step {step} after step {last_step}: steps must increase")
        last_step = step
        snapshot = _snapshot(lines, step, ignored, steps is None or step in steps)
        if snapshot:
            yield snapshot
    if last_step is None:
        raise BadInput(f"{lines.path}: is empty")


def _snapshot(lines, step, ignored, wanted):
    count = lines.number_below("ITEM: NUMBER OF ")
    low, high, periodic = _box(lines)
    header = lines.next()
    title = next((t for t in ("ITEM: ATOMS", "ITEM: ENTRIES") if header.startswith(t)), None)
    if not title:
        raise lines.bad(f"'{header.strip()[:60]}' where 'ITEM: ATOMS' or 'ITEM: ENTRIES' should stand")
    names = header[len(title):].split()
    # LIGGGHTS' manual itself writes 'type' twice in dumps: the first of equal names counts
    used = [i for i, name in enumerate(names) if name not in ignored and names.index(name) == i]
    first_row = lines.number + 1
    rows = lines.many(count)
    if len(rows) < count:
        raise lines.bad(f"ends after {len(rows)} of the {count} rows of step {step}")
    if not wanted:
        return None
    values = np.empty((0, len(used)))
    if count:
        try:
            with warnings.catch_warnings(action="ignore"):  # empty lines are counted below
                values = np.loadtxt(rows, usecols=used, ndmin=2, comments=None)
        except (ValueError, IndexError):
            raise BadInput(f"{lines.path}, {_first_bad_row(rows, names, used, first_row)}") from None
    if len(values) != count:
        raise lines.bad(f"empty lines among the rows of step {step}")
    return Snapshot(step, [names[i] for i in used], values, low, high, periodic)


def _box(lines):
    """Corners and periodicity from ITEM: BOX BOUNDS; a tilted box gives its bounding box."""
    styles = [word for word in lines.expect("ITEM: BOX BOUNDS") if word not in ("xy", "xz", "yz")]
    low, high = np.empty(3), np.empty(3)
    for axis in range(3):
        line = lines.next()
        try:
            low[axis], high[axis] = (float(word) for word in line.split()[:2])
        except ValueError:
            raise lines.bad(f"'{line.strip()}' gives no box bounds") from None
    return low, high, tuple(style == "pp" for style in styles) if len(styles) == 3 else (False,) * 3


def _first_bad_row(rows, names, used, first_row):
    for number, row in enumerate(rows, first_row):
        words = row.split()
        if len(words) < len(names):
            return f"line {number}: {len(words)} numbers in a row of {len(names)} columns"
        for i in used:
            try:
                float(words[i])
            except ValueError:
                return (f"line {number}: '{words[i]}' in column {names[i]} is no number; "
                        f"--ignore {names[i]} leaves the column out")
    return f"line {first_row}: rows of unequal length"
