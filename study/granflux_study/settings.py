# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A setting: one level of every knob; and the folder of inputs that it stands for."""

import hashlib
import json
from dataclasses import dataclass

from granflux_study.changes import Changes
from granflux_study.case import program_path

STARTUP = "startup"


@dataclass(frozen=True)
class Setting:
    """Labels in the order of the study's knobs; `startup`: the base setting with no steps."""

    labels: tuple
    startup: bool = False


def setting_of(study, levels):
    """The Setting with {knob: label}; knobs that are not named are at their base."""
    return Setting(tuple({**study.base, **levels}[knob.name] for knob in study.knobs))


def turned(study, setting):
    """{knob: label} of the knobs that are not at their base."""
    return {knob.name: label for knob, label in zip(study.knobs, setting.labels) if label != knob.base}


def named(study, setting):
    """The setting in words."""
    if setting.startup:
        return "start-up"
    words = [f"{name} {label}" + unit_of(study, name) for name, label in turned(study, setting).items()]
    return ", ".join(words) or "base"


def unit_of(study, name):
    unit = next(knob.unit for knob in study.knobs if knob.name == name)
    return f" {unit}" if unit else ""


def one_by_one(study):
    """Settings in which one knob is off its base, the base first: {setting: None}, in order."""
    found = {setting_of(study, {}): None}
    for knob in study.knobs:
        found.update({setting_of(study, {knob.name: level.label}): None for level in knob.levels})
    return list(found)


@dataclass(frozen=True)
class Inputs:
    """Command line, files {name: bytes}, and what identifies them."""

    words: tuple
    files: dict
    digest: str


def inputs_of(study, setting):
    changes = study.run.changes
    for knob, label in zip(study.knobs, setting.labels):
        changes = changes.then(knob.level(label).changes)
    if setting.startup:
        changes = changes.then(study.startup)
    return _inputs(study.run, changes, [study.ranks, study.threads, study.simulated_time, prepare_digest(study)])


def prepare_inputs(study):
    return _inputs(study.prepare, study.prepare.changes, [study.ranks, study.threads, list(study.keeps)])


def prepare_digest(study):
    return prepare_inputs(study).digest if study.prepare else ""


def _inputs(program, changes: Changes, more):
    files = {}
    for name, path in program.files.items():
        content = path.read_bytes()
        files[name] = changes.edited(name, content.decode()).encode() if name.endswith(".toml") else content
    words = (*program.command, *changes.words())
    identity = json.dumps([words, {n: hashlib.sha256(c).hexdigest() for n, c in sorted(files.items())}, more])
    return Inputs((program_path(words[0]), *words[1:]), files, hashlib.sha256(identity.encode()).hexdigest()[:16])
