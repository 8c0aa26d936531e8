#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the references of the examples anew, with the programs of build/release. They change only on purpose: say why
in the commit that renews them.

Usage: renew_examples.py [EXAMPLE...]
"""

import gzip
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

from examples import EXAMPLES, ROOT, run_example

HERE = pathlib.Path(__file__).parent
REFERENCES = HERE / "references"


def main(names):
    unknown = set(names) - set(EXAMPLES)
    if unknown:
        sys.exit(f"no example {', '.join(sorted(unknown))}: there are {', '.join(EXAMPLES)}")
    for program in ("granflux", "granflux_lammps", "granflux_cfd"):
        os.environ.setdefault(program.upper(), str(ROOT / "build/release/bin" / program))
    for name in names or EXAMPLES:
        with tempfile.TemporaryDirectory() as folder:
            text = run_example(name, pathlib.Path(folder))
        with open(REFERENCES / f"{name}.dump.gz", "wb") as out:
            out.write(gzip.compress(text.encode(), mtime=0))
        print(f"{name}: {len(text.splitlines())} lines", flush=True)
    version = subprocess.run([os.environ["GRANFLUX"], "-version"], capture_output=True, text=True, check=True).stdout
    made = {"command": "tests/regression/example_runs/renew_examples.py", "granflux": version.splitlines(),
            "machine": platform.machine(), "python": platform.python_version()}
    (REFERENCES / "manifest.json").write_text(json.dumps(made, indent=1) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
