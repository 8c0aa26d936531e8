# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every C++ file is formatted as .clang-format says.

Usage: format.py ROOT CLANG_FORMAT
"""

import subprocess
import sys
from pathlib import Path

from source_tree import cpp_files, report


def faults_of(root, clang_format):
    files = [str(path) for path in cpp_files(root)]
    done = subprocess.run(
        [clang_format, "--style=file", "--dry-run", "-Werror", *files],
        capture_output=True,
        text=True,
        check=False,
    )
    faults = {}  # the first of each file
    for line in done.stderr.splitlines():
        path, _, rest = line.partition(":")
        if path in files:
            faults.setdefault(path, line)
    if done.returncode != 0 and not faults:
        return [f"clang-format: exit code {done.returncode}: {done.stderr}"]
    return list(faults.values())


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]), sys.argv[2])))
