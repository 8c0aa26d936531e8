# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""How a value enters a run: a variable of the script, a key of a case file, an option of the program."""

import tomllib
from dataclasses import dataclass, field

from granflux_study.bad_input import BadInput
from granflux_study.toml_text import toml_text


@dataclass(frozen=True)
class Changes:
    variables: dict = field(default_factory=dict)  # {"dt": 1e-5}: -var dt 1e-5
    keys: dict = field(default_factory=dict)  # {"gas.toml:grid.cells": [2, 2, 4]}
    options: list = field(default_factory=list)  # more words of the command line

    def then(self, later):
        """Both; where they set the same, `later` is right."""
        return Changes({**self.variables, **later.variables}, {**self.keys, **later.keys},
                       self.options + later.options)

    def words(self):
        """What they add to the command line."""
        out = list(self.options)
        for name, value in self.variables.items():
            out += ["-var", name, value_text(value)]
        return out

    def edited(self, name, text):
        """The text of file `name` with the keys of that file set."""
        mine = {key.partition(":")[2]: value for key, value in self.keys.items() if key.partition(":")[0] == name}
        if not mine:
            return text
        document = tomllib.loads(text)
        for path, value in mine.items():
            table, last = find(document, path)
            table[last] = value
        return toml_text(document)


def value_text(value):
    """As it is written in scripts, messages and tables."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, float):
        return f"{value:.12g}"
    if isinstance(value, list):
        return " x ".join(map(value_text, value))
    return str(value)


def find(document, path):
    """The table and the last word of a dotted path; a word that is a number counts tables of an array from 1."""
    *outer, last = path.split(".")
    table = document
    for word in outer:
        if isinstance(table, list):
            if not word.isdigit() or not 1 <= int(word) <= len(table):
                raise KeyError(word)
            table = table[int(word) - 1]
        else:
            table = table[word]
    if not isinstance(table, dict) or last not in table:
        raise KeyError(last)
    return table, last


def read_changes(table, files):
    """Keys `variables`, `keys` and `options` of a CheckedTable, all of which must be in `files` {name: text}."""
    variables = table.get("variables", lambda v: isinstance(v, dict), "a table of variables", {})
    keys = table.get("keys", lambda v: isinstance(v, dict), 'a table of "FILE:TABLE.KEY" = value', {})
    for name, value in variables.items():
        check_variable(table, name, files)
        if isinstance(value, (dict, list)):
            raise BadInput(f"{table.where} variables {name} = {value!r}: must be a number or a text")
    for key in keys:
        check_key(table, key, files)
    return Changes(dict(variables), dict(keys), table.words("options", []))


def check_variable(table, name, files):
    """That a script has a line 'variable NAME index ...', which the command line can then set."""
    known = sorted({words[1] for text in files.values() for words in map(str.split, text.splitlines())
                    if len(words) > 2 and words[0] == "variable" and words[2] == "index"})
    if name not in known:
        raise BadInput(f"{table.where}: no script has a line 'variable {name} index VALUE'; "
                       f"those that can be set: {', '.join(known) or 'none'}")


def check_key(table, key, files):
    """That a case file has the key. One that is left at its default is to be written there first."""
    name, colon, path = key.partition(":")
    cases = [f for f in files if f.endswith(".toml")]
    if not colon or name not in cases:
        raise BadInput(f"{table.where}: {key}: must be FILE:TABLE.KEY with FILE one of {', '.join(cases) or 'none'}")
    try:
        document = tomllib.loads(files[name])
    except tomllib.TOMLDecodeError as problem:
        raise BadInput(f"{name}: {problem}") from problem
    try:
        find(document, path)
    except (KeyError, TypeError) as problem:
        raise BadInput(f"{table.where}: {name} has no key {path}; there are {', '.join(_paths(document, ()))}. "
                       "Write a key with its default into the file to make it a knob.") from problem


def _paths(node, path):
    if isinstance(node, dict):
        return [p for key, value in node.items() for p in _paths(value, path + (key,))]
    if isinstance(node, list) and node and all(isinstance(v, dict) for v in node):
        return [p for n, value in enumerate(node, 1) for p in _paths(value, path + (str(n),))]
    return [".".join(path)]
