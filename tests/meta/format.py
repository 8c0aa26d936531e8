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
    faults = []
    for path in cpp_files(root):
        done = subprocess.run(
            [clang_format, "--style=file", "--dry-run", "-Werror", str(path)],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            lines = done.stderr.splitlines()
            faults.append(lines[0] if lines else f"{path}: exit code {done.returncode}")
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]), sys.argv[2])))
