# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every source file names its licence, the one of its folder (LICENSE), in its first lines.

Usage: licences.py ROOT
"""

import sys
from pathlib import Path

from source_tree import files, report

HOLDER = "SPDX-FileCopyrightText: 2026 The GranFlux developers"
SUFFIXES = {".cpp", ".hpp", ".py", ".sh", ".cmake", ".in"}
NAMES = {"CMakeLists.txt", "run", "test", "build"}


def is_source(path):
    # in.NAME is an input script of LIGGGHTS, NAME.in a template
    return path.suffix in SUFFIXES or path.name in NAMES


def faults_of(root):
    faults = []
    for path in filter(is_source, files(root)):
        inside = path.relative_to(root)
        licence = "GPL-2.0-or-later" if inside.parts[0] == "liggghts_plugin" else "BSD-3-Clause"
        head = "\n".join(path.read_text().splitlines()[:3])
        if HOLDER not in head:
            faults.append(f"{inside}: no line {HOLDER}")
        if f"SPDX-License-Identifier: {licence}" not in head:
            faults.append(f"{inside}: no line SPDX-License-Identifier: {licence}")
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]))))
