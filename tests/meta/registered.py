# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every source file of a folder is named in the CMakeLists.txt that builds it: no test is orphaned,
no public header escapes the check that it compiles alone, and every script is executable.

Usage: registered.py ROOT
"""

import os
import re
import sys
from pathlib import Path

from source_tree import cpp_files, report

SCRIPTS = ["run", "test", "scripts/build", ".ci/run"]


def words(text):
    return set(re.findall(r"[\w./+-]+", re.sub(r"#.*", "", text)))


def unregistered(root, path):
    """Whether no CMakeLists.txt between a file and the root names it."""
    for folder in path.parents:
        lists = folder / "CMakeLists.txt"
        if lists.exists() and str(path.relative_to(folder)) in words(lists.read_text()):
            return False
        if folder == root:
            return True
    return True


def faults_of(root):
    faults = []
    for part in ("cfd_lib", "coupling", "liggghts_plugin", "tests"):
        for path in cpp_files(root / part) if (root / part).is_dir() else []:
            public_header = path.suffix == ".hpp" and "include" in path.relative_to(root).parts
            of_all_tests = (root / "tests" / "support") in path.parents
            if (path.suffix == ".cpp" or public_header) and not of_all_tests:
                if unregistered(root, path):
                    faults.append(f"{path.relative_to(root)}: in no CMakeLists.txt")
    for script in SCRIPTS:
        if not os.access(root / script, os.X_OK):
            faults.append(f"{script}: not executable")
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]))))
