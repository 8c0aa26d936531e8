# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every public header compiles alone. The build has shown it of those that a source file of their library
includes first; the others are compiled here, without generating code.

Usage: headers_alone.py ROOT COMPILER [FLAG...]
"""

import re
import subprocess
import sys
from pathlib import Path

from source_tree import files, report

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
LIBRARIES = ("cfd_lib", "coupling")


def included_first(sources):
    """Headers that come before any other in a source file."""
    firsts = (INCLUDE.search(path.read_text()) for path in files(sources) if path.suffix == ".cpp")
    return {match.group(1) for match in firsts if match}


def faults_of(root, compiler, flags):
    faults = []
    search = [f"-I{root / library / 'include'}" for library in LIBRARIES]
    for library in LIBRARIES:
        shown = included_first(root / library / "src")
        for path in files(root / library / "include"):
            header = str(path.relative_to(root / library / "include"))
            if path.suffix != ".hpp" or header in shown:
                continue
            done = subprocess.run(
                [compiler, *flags, *search, "-fsyntax-only", "-x", "c++", "-"],
                input=f"#include <{header}>\n",
                capture_output=True,
                text=True,
                check=False,
            )
            if done.returncode != 0:
                faults.append(f"{path.relative_to(root)}: does not compile alone\n{done.stderr}")
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]), sys.argv[2], sys.argv[3:])))
