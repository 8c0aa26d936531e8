# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs commands of a page as its reader would: one after the other in an empty folder that has the files printed on the
page, with the programs of the build on the path."""

import os
import re
import subprocess
import tempfile
from pathlib import Path

FILE = re.compile(r"^`([\w.]+)`[^\n]*(?:\n[^\n`][^\n]*)*\n\n```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Open MPI as ./run has it: also as root, also on fewer cores than ranks.
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
       "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_ess_singleton_isolated": "1"}


def files_of(text):
    """{name: content} of the blocks whose paragraph before begins with the name of a file."""
    return dict(FILE.findall(text))


def fault_of(text, commands, root, build):
    """What went wrong, or None. commands: (command, shell line that prepares it or "") in the page's order."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in files_of(text).items():
            Path(folder, name).write_text(content)
        lines = [line for command, before in commands for line in (before, f"set -x; {command}", "{ set +x; } 2>&-")]
        env = {**os.environ, **MPI, "ROOT": str(root), "PATH": f"{build}/bin:{os.environ['PATH']}"}
        done = subprocess.run(["bash", "-e", "-o", "pipefail", "-c", "\n".join(lines)], cwd=folder, env=env, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=250, check=False)
        return None if done.returncode == 0 else f"exit code {done.returncode}\n{done.stdout[-3000:]}"
