# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The cases of cases.txt."""

import pathlib
from dataclasses import dataclass

TABLE = pathlib.Path(__file__).parent / "cases.txt"
OPTIONS = {  # column: what it may say
    "density": ("dense", "dilute"),
    "normal": ("hooke", "hooke/stiffness", "hertz", "hertz/stiffness"),
    "tangential": ("history", "no_history"),
    "rolling": ("off", "cdt", "epsd2"),
    "cohesion": ("off", "sjkr"),
    "types": ("1", "3"),
    "sizes": ("equal", "poly"),
    "frozen": ("no", "yes"),
    "container": ("planes", "cylinder", "mesh", "periodic"),
    "runs": ("short", "long"),
}


@dataclass(frozen=True)
class Case:
    name: str
    density: str
    normal: str
    tangential: str
    rolling: str
    cohesion: str
    types: str
    sizes: str
    frozen: str
    container: str
    runs: str

    @property
    def model(self):
        """The words after 'gran model'; their order is fixed in LIGGGHTS."""
        words = f"{self.normal} tangential {self.tangential}"
        if self.cohesion != "off":
            words += f" cohesion {self.cohesion}"
        if self.rolling != "off":
            words += f" rolling_friction {self.rolling}"
        return words

    @property
    def type_count(self):
        return int(self.types)

    @property
    def history_size(self):
        """Numbers that a contact remembers."""
        return 3 * (self.tangential == "history") + 3 * (self.rolling == "epsd2")


def read_cases(path=TABLE):
    cases = []
    for line in path.read_text().splitlines():
        words = line.partition("#")[0].split()
        if words:
            cases.append(Case(*words))
            for column, allowed in OPTIONS.items():
                if getattr(cases[-1], column) not in allowed:
                    raise ValueError(f"{path}: {line}: {column} must be one of {allowed}")
    return cases
