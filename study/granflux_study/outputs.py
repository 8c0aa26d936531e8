# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What runs write: series of numbers or profiles over time."""

import re

import numpy as np

from granflux_study.bad_input import BadInput

FORMATS = ("thermo", "table", "profile", "printed")


def read_series(path, quantity, simulated_time):
    """Times (n,) in s and values (n, m) of a quantity; m is 1 unless it is a profile.

    thermo: last table of a log of LIGGGHTS or LAMMPS that has the column; times from its column Time.
    table: columns under a line of headings, separated by commas or blanks; times from the first column.
    profile: blocks of 'fix ave/spatial' or 'fix ave/chunk'; their steps stand for 0 to `simulated_time`.
    printed: what the last match of `pattern` puts in brackets.
    """
    try:
        text = path.read_text()
    except OSError as problem:
        raise BadInput(f'quantity "{quantity.name}": {path}: {problem.strerror}') from problem
    if quantity.form == "printed":
        times, values = _printed(text, quantity)
    elif quantity.form == "profile":
        times, values = _profile(text, quantity, simulated_time)
    else:
        times, values = (_thermo if quantity.form == "thermo" else _table)(text, quantity)
    if not np.all(np.isfinite(values)):
        raise BadInput(f'quantity "{quantity.name}": {path.name} holds {values[~np.isfinite(values)][0]}')
    return times, values * quantity.factor


def _bare(heading):
    """LIGGGHTS leaves f_, v_ and c_ out of its headings, LAMMPS does not."""
    return re.sub(r"^[fvc]_", "", heading)


def _column(heads, name, quantity):
    bare = [_bare(head) for head in heads]
    if _bare(name) not in bare:
        raise BadInput(f'quantity "{quantity.name}": {quantity.file} has no column {name}; there are {", ".join(heads)}')
    return bare.index(_bare(name))


def _numbers(words):
    try:
        return [float(word) for word in words]
    except ValueError:
        return None


def _thermo(text, quantity):
    found, heads, rows = None, [], None
    for line in text.splitlines():
        words = line.split()
        if words and words[0] == "Step":
            heads, rows = words, []
            if _bare(quantity.column) in map(_bare, words):
                found = (words, rows)
        elif rows is not None and len(words) == len(heads) and (numbers := _numbers(words)):
            rows.append(numbers)
        elif line.startswith("Loop time"):
            rows = None
    if found is None:
        raise BadInput(f'quantity "{quantity.name}": {quantity.file} has no table with a column {quantity.column}; '
                       f"the last has {', '.join(heads) or 'none'}")
    heads, rows = found
    if not rows:
        raise BadInput(f'quantity "{quantity.name}": the table of {quantity.file} is empty')
    rows = np.array(rows)
    return rows[:, _column(heads, "Time", quantity)], rows[:, [_column(heads, quantity.column, quantity)]]


def _table(text, quantity):
    lines = [line.lstrip("# ") for line in text.splitlines() if line.strip()]
    rows = [re.split(r"\s*,\s*|\s+", line.strip()) for line in lines]
    heads = rows[0] if rows else []
    column = _column(heads, quantity.column, quantity)
    numbers = [n for row in rows[1:] if len(row) == len(heads) and (n := _numbers(row))]
    if not numbers:
        raise BadInput(f'quantity "{quantity.name}": the table of {quantity.file} is empty')
    numbers = np.array(numbers)
    return numbers[:, 0], numbers[:, [column]]


def _profile(text, quantity, simulated_time):
    heads = []
    lines = [line for line in text.splitlines() if line.strip()]
    for line in lines:
        if not line.startswith("#"):
            break
        heads = line.lstrip("# ").split()
    column = _column(heads, quantity.column, quantity)
    rows = [line.split() for line in lines if not line.startswith("#")]
    steps, profiles, at = [], [], 0
    while at < len(rows):
        count = int(rows[at][1])
        block = rows[at + 1 : at + 1 + count]
        if len(block) < count:
            break  # not written to the end
        steps.append(float(rows[at][0]))
        profiles.append([float(row[column]) for row in block])
        at += 1 + count
    if not profiles or steps[-1] <= 0:
        raise BadInput(f'quantity "{quantity.name}": {quantity.file} has no profile')
    if len({len(profile) for profile in profiles}) > 1:
        raise BadInput(f'quantity "{quantity.name}": the profiles of {quantity.file} differ in length')
    return np.array(steps) / steps[-1] * simulated_time, np.array(profiles)


def _printed(text, quantity):
    try:
        found = re.findall(quantity.pattern, text, re.MULTILINE)
    except re.error as problem:
        raise BadInput(f'quantity "{quantity.name}" pattern = {quantity.pattern!r}: {problem}') from problem
    if not found or not isinstance(found[-1], str) or (number := _numbers(found[-1:])) is None:
        raise BadInput(f'quantity "{quantity.name}" pattern = {quantity.pattern!r}: must put one number in brackets '
                       f"and be found in what the run prints; found {found[-1:] or 'nothing'}")
    return np.array([0.0]), np.array([number])
