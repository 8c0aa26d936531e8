# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A case to be studied: the file study.toml of a folder, checked as a whole before anything runs."""

import math
import shutil
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from granflux_study.bad_input import BadInput
from granflux_study.changes import Changes, check_key, check_variable, read_changes, value_text
from granflux_study.checked_table import CheckedTable
from granflux_study.outputs import FORMATS

FINEST = "finest"
HOW = ("mean", "final")


@dataclass(frozen=True)
class Level:
    label: str
    changes: Changes


@dataclass(frozen=True)
class Knob:
    """One thing that can be set; its levels from the quickest to the most accurate."""

    name: str
    unit: str
    levels: tuple
    base: str  # label of the level that the run has while other knobs are turned

    @property
    def finest(self):
        return self.levels[-1].label

    def level(self, label):
        return next(level for level in self.levels if level.label == label)


@dataclass(frozen=True)
class Quantity:
    """What is to be right, and where it is found."""

    name: str
    unit: str
    file: str  # of a run's folder; "stdout" for what it prints
    form: str  # one of FORMATS
    column: str
    pattern: str
    how: str  # one of HOW
    window: tuple  # from, to: s
    factor: float  # the column times this
    right: object  # None: of the reference run; else an array
    scale: object  # None: root mean square of what is right
    judged: bool  # counts where settings are recommended


@dataclass(frozen=True)
class Program:
    """One command line with the files it reads: {name: path}."""

    command: tuple
    files: dict
    changes: Changes


@dataclass(frozen=True)
class Study:
    title: str
    folder: Path
    run: Program
    startup: object  # Changes for a run of no steps, or None
    prepare: object  # Program or None
    keeps: tuple  # files that `prepare` makes for the runs
    simulated_time: float  # s
    ranks: int
    threads: int
    repeats: int
    time_limit: float  # s
    chaotic: bool
    reference: object  # FINEST, or {knob: label} of all knobs
    knobs: tuple
    quantities: tuple

    @property
    def base(self):
        """{knob: label}"""
        return {knob.name: knob.base for knob in self.knobs}


def read_study(folder):
    """The Study of `folder`/study.toml; BadInput where it is not right."""
    path = Path(folder) / "study.toml"
    try:
        document = tomllib.loads(path.read_text())
    except OSError as problem:
        raise BadInput(f"{path}: {problem.strerror}; a case is a folder with a file study.toml") from problem
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as problem:
        raise BadInput(f"{path}: {problem}") from problem
    top = CheckedTable(document, "study.toml:")
    title = top.text("title")
    chaotic = top.flag("chaotic", False)
    run = CheckedTable(top.get("run", lambda v: isinstance(v, dict), "a table"), "study.toml: [run]")
    program, files = _program(run, path.parent)
    startup = None
    if "startup" in run:
        startup_table = run.table("startup")
        startup = read_changes(startup_table, files)
        startup_table.close()
    prepare, keeps = None, ()
    if "prepare" in top:
        table = CheckedTable(top.get("prepare", lambda v: isinstance(v, dict), "a table"), "study.toml: [prepare]")
        prepare, _ = _program(table, path.parent)
        keeps = tuple(table.words("keeps", least=1))
        table.close()
    knobs = tuple(_knob(table, files) for table in top.tables("knob", 1))
    _distinct([k.name for k in knobs], "[[knob]]")
    _apart(knobs)
    quantities = tuple(_quantity(table, path.parent) for table in top.tables("quantity", 1))
    _distinct([q.name for q in quantities], "[[quantity]]")
    if not any(q.judged for q in quantities):
        raise BadInput("study.toml: [[quantity]] judged = false: at least one quantity must be judged")
    study = Study(
        title=title, folder=path.parent, run=program, startup=startup, prepare=prepare, keeps=keeps,
        simulated_time=run.number("simulated_time", above=0), ranks=run.whole("ranks", 1, 1),
        threads=run.whole("threads", 1, 1), repeats=run.whole("repeats", 1, 1),
        time_limit=run.number("time_limit", 3600.0, above=0), chaotic=chaotic,
        reference=_reference(top, knobs), knobs=knobs, quantities=quantities)
    run.close()
    top.close()
    return study


def program_path(name):
    """Full path of a program: beside this one, else on PATH."""
    beside = Path(sys.argv[0]).resolve().parent / name
    found = str(beside) if beside.is_file() and "/" not in name else shutil.which(name)
    if found is None:
        raise BadInput(f"{name}: there is no such program, neither beside granflux_study nor on PATH")
    return found


def _program(table, folder):
    command = table.words("command", least=1)
    files, texts = {}, {}
    for word in table.words("files", []):
        path = folder / word
        if not path.is_file():
            raise BadInput(f"{table.where} files: there is no file {path}")
        if path.name in files:
            raise BadInput(f"{table.where} files: two are called {path.name}")
        files[path.name] = path
        try:
            texts[path.name] = path.read_text()
        except UnicodeDecodeError:
            pass  # of no interest for what can be set
    return Program(tuple(command), files, read_changes(table, texts)), texts


def _knob(table, files):
    name = table.text("name")
    table.where += f' "{name}"'
    unit = table.text("unit", "")
    ways = [way for way in ("variable", "key", "option", "levels") if way in table]
    if len(ways) != 1:
        raise BadInput(f"{table.where}: must have one of variable, key, option, levels; has {', '.join(ways) or 'none'}")
    way = ways[0]
    if way == "levels":
        levels = []
        for one in table.tables("levels", 2):
            label = one.text("label")
            one.where = f'{table.where} level "{label}"'
            levels.append(Level(label, read_changes(one, files)))
            one.close()
    else:
        target = table.text(way)
        if way == "variable":
            check_variable(table, target, files)
        if way == "key":
            check_key(table, target, files)
        values = table.get("values", lambda v: isinstance(v, list) and len(v) > 1, "a list of two values or more")
        if way != "key" and any(isinstance(v, (list, dict)) for v in values):
            table.refuse("values", "numbers or texts")
        levels = [Level(value_text(v), _change(way, target, v)) for v in values]
    _distinct([level.label for level in levels], f"{table.where} levels")
    base = levels[-1].label
    if "base" in table:
        base = value_text(table.get("base", lambda v: True, ""))
        _known(base, levels, f"{table.where} base")
    table.close()
    return Knob(name, unit, tuple(levels), base)


def _change(way, target, value):
    if way == "variable":
        return Changes(variables={target: value})
    if way == "key":
        return Changes(keys={target: value})
    return Changes(options=[target, value_text(value)])


def _known(label, levels, where):
    if label not in [level.label for level in levels]:
        raise BadInput(f"{where} = {label}: must be one of its levels: {', '.join(level.label for level in levels)}")


def _reference(top, knobs):
    if isinstance(top.values.get("reference"), dict):
        table = top.table("reference")
        labels = {}
        for knob in knobs:
            labels[knob.name] = value_text(table.get(knob.name, lambda v: True, "", knob.finest))
            _known(labels[knob.name], knob.levels, f"{table.where} {knob.name}")
        table.close()
        return labels
    return top.get("reference", lambda v: v == FINEST, f'"{FINEST}", or a table [reference] of knobs and levels', FINEST)


def _quantity(table, folder):
    name = table.text("name")
    table.where += f' "{name}"'
    form = table.choice("format", FORMATS)
    start = table.number("from", -math.inf)
    right = None
    if "closed_form" in table:
        right = np.array([table.number("closed_form")])
    if "against" in table:
        if right is not None:
            raise BadInput(f"{table.where}: closed_form and against: must be one of them")
        right = _profile_file(table, folder)
    scale = table.number("scale", above=0) if "scale" in table else None
    if scale is None and right is not None and not np.any(right):
        raise BadInput(f"{table.where} scale: missing; errors relative to 0 need one")
    out = Quantity(
        name=name, unit=table.text("unit", ""), file="stdout" if form == "printed" else table.text("file"), form=form,
        column="" if form == "printed" else table.text("column"),
        pattern=table.text("pattern") if form == "printed" else "",
        how="final" if form == "printed" else table.choice("how", HOW, "mean"),
        window=(start, table.number("to", math.inf, above=start)), factor=table.number("factor", 1.0), right=right,
        scale=scale, judged=table.flag("judged", True))
    if out.how == "final" and (math.isfinite(out.window[0]) or math.isfinite(out.window[1])):
        raise BadInput(f'{table.where}: from and to go with how = "mean" only')
    table.close()
    return out


def _profile_file(table, folder):
    """One number a line: what a profile should be."""
    path = folder / table.text("against")
    try:
        values = np.loadtxt(path, ndmin=1)
    except (OSError, ValueError) as problem:
        raise BadInput(f"{table.where} against: {path}: {problem}; must be a file with one number a line") from problem
    if values.ndim != 1 or not np.all(np.isfinite(values)):
        raise BadInput(f"{table.where} against: {path}: must be a file with one number a line")
    return values


def _apart(knobs):
    """No two knobs may set the same: one would undo what the other's label says."""
    owners = {}
    for knob in knobs:
        for name in {n for level in knob.levels for n in (*level.changes.variables, *level.changes.keys)}:
            other = owners.setdefault(name, knob.name)
            if other != knob.name:
                raise BadInput(f'study.toml: [[knob]] "{knob.name}" and "{other}" both set {name}: one knob must set it')


def _distinct(names, where):
    for name in names:
        if names.count(name) > 1:
            raise BadInput(f"study.toml: {where}: two are called {name}")
