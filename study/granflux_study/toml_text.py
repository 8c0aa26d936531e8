# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A TOML document as text: Python reads TOML, but does not write it."""

import json
import math


def toml_text(document):
    """`document`: tables as dictionaries, as tomllib reads them. Comments and order of tables are not kept."""
    return "\n".join(_lines(document, ())) + "\n"


def _lines(table, path):
    plain, inner = [], []
    for key, value in table.items():
        if isinstance(value, dict):
            inner += ["", f"[{_path(path + (key,))}]"] + _lines(value, path + (key,))
        elif isinstance(value, list) and value and all(isinstance(v, dict) for v in value):
            for one in value:
                inner += ["", f"[[{_path(path + (key,))}]]"] + _lines(one, path + (key,))
        else:
            plain.append(f"{_key(key)} = {_value(value)}")
    return plain + inner


def _path(path):
    return ".".join(map(_key, path))


def _key(key):
    plain = key and all(c.isascii() and (c.isalnum() or c in "_-") for c in key)
    return key if plain else json.dumps(key, ensure_ascii=False)


def _value(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else ("nan" if math.isnan(value) else "inf" if value > 0 else "-inf")
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + "}"
    return value.isoformat()  # dates and times
