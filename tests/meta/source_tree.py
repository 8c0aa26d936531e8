# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The files of the source tree that the checks look at."""

from pathlib import Path

LEFT_OUT = {"build", ".git", ".cache", "__pycache__", "post", "results"}


def files(root):
    """All files below root that are neither built nor made by a run, in order."""
    found = []
    for path in sorted(Path(root).iterdir()):
        if path.is_dir():
            if path.name not in LEFT_OUT or path.parent.name == "docs":  # docs/results: pages
                found += files(path)
        else:
            found.append(path)
    return found


def cpp_files(root):
    return [path for path in files(root) if path.suffix in (".cpp", ".hpp")]


def report(faults):
    """Prints the faults; the exit code that goes with them."""
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults" if faults else "no faults")
    return 1 if faults else 0
