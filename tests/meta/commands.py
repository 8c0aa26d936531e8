# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every command line of a page can be given as it stands: what is quick is run, examples and their options exist,
presets exist, names of tests are those of tests, programs start. commands.txt says which are run, and of those that
can neither be run here nor be looked at which test makes the run or why none does.

Usage: commands.py ROOT BUILD CTEST
"""

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import run_commands
from links import pages
from source_tree import report

PROGRAMS = ("./run", "./test", "mpirun", "cmake", "cpack", "ctest", "granflux", "granflux_cfd", "granflux_lammps",
            "granflux-regress", "granflux_study", "liggghts", "lmp", "python3", "cd", "cp", "mkdir", "apt", "patch",
            "valgrind", "callgrind_annotate", "paraview")
FOLDERS = ("tests/", "scripts/", "examples/", "build/", "../")
SHELL = {"bash", "sh", "console"}  # languages of fenced blocks
SYNOPSIS = re.compile(r" \[|\b(FILE|DIR|CASE|REFERENCE|N)\b|\.\.\.")


def lines_of_code(text):
    """(line number, line) of indented and of shell blocks, continued lines joined."""
    fence, held, start = None, "", 0
    for number, line in enumerate(text.splitlines(), 1):
        if mark := re.match(r"^```(\w*)", line):
            fence = None if fence is not None else mark.group(1)
            continue
        indented = fence is None and line.startswith("    ")
        if not (indented or fence in SHELL):
            continue
        start, held = (start, held) if held else (number, "")
        held += line.strip()
        if held.endswith("\\"):
            held = held[:-1]
            continue
        yield start, held
        held = ""


def commands_of(text):
    for number, line in lines_of_code(text):
        line = re.sub(r"\s+#.*", "", line.removeprefix("$ "))
        first = line.split()[:1]
        if first and (first[0] in PROGRAMS or first[0].startswith(FOLDERS)) and not SYNOPSIS.search(line):
            yield number, line


def exceptions_of(text):
    """{command: covered by} from lines 'command -> reason'."""
    pairs = (line.partition(" -> ") for line in text.splitlines() if line and not line.startswith("#"))
    return {command.strip(): reason.strip() for command, _, reason in pairs}


def preparation(reason):
    """Shell line that a command needs before it is run, None where it is not to be run."""
    return told.group(1) or "" if (told := re.fullmatch(r"runs(?: after (.*))?", reason)) else None


def output_of(words, cwd):
    done = subprocess.run(words, cwd=cwd, capture_output=True, text=True, timeout=60, check=False)
    return done.stdout + done.stderr if done.returncode == 0 else None


class Checker:
    """Says what is wrong with a command, nothing where it is right, and raises KeyError where it cannot tell."""

    def __init__(self, root, build, ctest):
        self.root, self.build, self.ctest = root, build, ctest
        presets = json.loads((root / "CMakePresets.json").read_text())["configurePresets"]
        self.presets = {p["name"] for p in presets if not p.get("hidden")}
        listing = output_of([ctest, "--test-dir", str(build), "-N"], root) or ""
        self.tests = re.findall(r"Test +#\d+: (\S+)", listing)
        self.help = {}

    def fault(self, command):
        words = shlex.split(command)
        if words[0] == "./run":
            return self.example(words[1:])
        if words[0] == "./test":
            return self.named_tests(words[1:])
        if words[0] == "ctest":
            return self.named_tests(words[1:]) or self.named_presets(words)
        if words[0] == "cmake" and "--preset" in words:
            return self.named_presets(words)
        if words[0].startswith("tests/") and os.access(self.root / words[0], os.X_OK):
            return self.options([words[0], *[w for w in words[1:2] if re.fullmatch(r"\w+", w)]], words)
        for program in ("granflux_cfd", "granflux-regress", "granflux_study"):
            if program in words[:4]:
                return self.options([str(self.build / "bin" / program)], words)
        raise KeyError(command)

    def example(self, words):
        name = words[0] if words and not words[0].startswith("-") else "fluidized_bed"
        if not (self.root / "examples" / name / "run.sh").exists():
            return None if words in (["--list"], ["--help"]) else f"there is no example {name}"
        return self.options(["./run", name], words)

    def options(self, program, words):
        key = tuple(program)
        if key not in self.help:
            self.help[key] = output_of([*program, "--help"], self.root) or ""
        unknown = [w for w in words if w.startswith("--") and w not in self.help[key] and w != "--help"]
        return f"no option {', '.join(unknown)} in the help of {' '.join(program)}" if unknown else None

    def named_tests(self, words):
        for option, name in zip(words, words[1:]):
            if option == "-R" and not any(re.search(name, test) for test in self.tests):
                return f"no test is called {name}"
        return None

    def named_presets(self, words):
        named = {name for option, name in zip(words, words[1:]) if option == "--preset"}
        return f"no preset {', '.join(sorted(named - self.presets))}" if named - self.presets else None


def faults_of(root, build, ctest):
    checker = Checker(root, build, ctest)
    exceptions = exceptions_of((root / "tests/meta/commands.txt").read_text())
    faults, used = [], set()
    for command, reason in exceptions.items():
        if (test := re.search(r"\btest ([\w.]+)$", reason)) and test.group(1) not in checker.tests:
            faults.append(f"tests/meta/commands.txt: {command}: there is no test {test.group(1)}")
    for page in pages(root):
        to_run = []
        for number, command in commands_of(page.read_text()):
            where = f"{page.relative_to(root)}:{number}: {command}"
            if command in exceptions:
                used.add(command)
                if (before := preparation(exceptions[command])) is not None:
                    to_run.append((command, before))
                continue
            try:
                fault = checker.fault(command)
            except KeyError:
                fault = "neither checked nor in tests/meta/commands.txt"
            if fault:
                faults.append(f"{where}: {fault}")
        if to_run and (fault := run_commands.fault_of(page.read_text(), to_run, root, build)):
            faults.append(f"{page.relative_to(root)}: {fault}")
    faults += [f"tests/meta/commands.txt: {command}: on no page" for command in sorted(exceptions.keys() - used)]
    return faults


if __name__ == "__main__":
    sys.exit(report(faults_of(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3])))
