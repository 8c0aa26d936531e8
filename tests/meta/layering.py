# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Layering: cfd_lib <- coupling <- liggghts_plugin; arrows point one way.

Usage: layering.py ROOT
"""

import re
import sys
from pathlib import Path

from source_tree import cpp_files, report

# Folder: the GranFlux headers it may include.
MAY_INCLUDE = {
    "cfd_lib": r"granflux/(cfd/|version\.hpp)",
    "coupling": r"granflux/(cfd|coupling)/",
    "liggghts_plugin": r"granflux/(cfd/|coupling/|version\.hpp)",
    "tests/cfd": r"granflux/cfd/",
    "tests/case_file": r"granflux/cfd/",
    "tests/coupling": r"granflux/(cfd|coupling)/",
}
# Libraries that stay out of the public headers, and headers of a host that only its plugin sees.
PRIVATE_LIBRARY = re.compile(r"(Eigen/|toml\+\+/|fmt/|CLI/|cgns)")
HOST_HEADER = re.compile(
    r"(liggghts/.*|lammps/.*|(lammps|atom|fix|fix_\w+|pair|pair_\w+|modify|update|neighbor|force|"
    r"error|memory|comm|domain|input|output|compute|contact_models|pointers|style_\w+)\.h)$"
)
# Folders of the plugin: the host whose headers they may include. Both hosts have classes of the same
# names and other layouts.
HOST_OF = {"driver": None, "liggghts": "liggghts/", "lammps": "lammps/"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def faults_of(root):
    faults = []
    for folder, allowed in MAY_INCLUDE.items():
        base = Path(root) / folder
        for path in cpp_files(base) if base.is_dir() else []:
            public = "include" in path.relative_to(base).parts
            for number, line in enumerate(path.read_text().splitlines(), 1):
                match = INCLUDE.match(line)
                if not match:
                    continue
                quote, header = match.groups()
                where = f"{path.relative_to(root)}:{number}: includes {header}: "
                if header.startswith("granflux/") and not re.match(allowed, header):
                    faults.append(where + f"{folder} may include {allowed} only")
                if folder != "liggghts_plugin" and HOST_HEADER.match(header):
                    faults.append(where + "a host's header, for its plugin only")
                if folder == "liggghts_plugin" and quote == "<":
                    part = path.relative_to(base).parts[0]
                    if HOST_HEADER.match(header) and part in HOST_OF:
                        if not HOST_OF[part] or not header.startswith(HOST_OF[part]):
                            faults.append(where + f"a host's header that {part} may not see")
                if public and PRIVATE_LIBRARY.match(header):
                    faults.append(where + "stays out of public headers")
                if quote == '"' and not folder.startswith("tests"):
                    target = (path.parent / header).resolve()
                    if target.exists() and base.resolve() not in target.parents:
                        faults.append(where + f"lies outside {folder}")
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]))))
