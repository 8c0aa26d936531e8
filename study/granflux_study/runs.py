# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of a study: started, timed, kept, and found again.

results/runs/<settings>-<program>/<n>/ holds inputs, outputs and run.json of the n-th run of a setting.
<settings> is a digest of command line and input files, <program> one of the program file.
"""

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import threading
import time
from dataclasses import asdict, dataclass
from pathlib import Path

from granflux_study.bad_input import BadInput
from granflux_study.settings import inputs_of, prepare_inputs, setting_of

RECORD = "run.json"


@dataclass(frozen=True)
class Record:
    """What is noted of one run; processor and wall time in s."""

    labels: list
    command: list
    failure: str  # empty: came to its end
    processor_time: float
    wall_time: float
    version: str


class Runs:
    """The runs of one study in one folder of results."""

    def __init__(self, study, results, any_version=False):
        self.study, self.folder, self.any_version = study, Path(results) / "runs", any_version
        self.folder.mkdir(parents=True, exist_ok=True)
        for torn in self.folder.glob("*/*.part"):
            shutil.rmtree(torn)
        self._children, self._lock, self._stopped = {}, threading.Lock(), False
        self._program = program_identity(inputs_of(study, setting_of(study, {})).words[0])

    def place(self, inputs, number):
        """Folder of the n-th run with these inputs."""
        digest, _ = self._program
        if self.any_version:
            done = sorted(self.folder.glob(f"{inputs.digest}-*/{number}/{RECORD}"))
            if done:
                return done[-1].parent
        return self.folder / f"{inputs.digest}-{digest}" / str(number)

    def records(self, setting):
        """[(folder, Record)] of the runs of a setting that have been made."""
        inputs, found = inputs_of(self.study, setting), []
        for number in range(1, self.study.repeats + 1):
            folder = self.place(inputs, number)
            if (folder / RECORD).exists():
                found.append((folder, read_record(folder)))
        return found

    def missing(self, setting):
        """Numbers of the runs of a setting that have yet to be made: none where one has failed."""
        if any(record.failure for _, record in self.records(setting)):
            return []
        inputs = inputs_of(self.study, setting)
        return [n for n in range(1, self.study.repeats + 1) if not (self.place(inputs, n) / RECORD).exists()]

    def known(self):
        """Labels of all settings of which there is a record, whether or not they are part of the study now."""
        return {tuple(read_record(path.parent).labels) for path in sorted(self.folder.glob(f"*/1/{RECORD}"))}

    def prepare(self):
        """What all runs start from; made if it is not there."""
        if self.study.prepare is None:
            return
        inputs = prepare_inputs(self.study)
        folder = self.place(inputs, 1)
        if not (folder / RECORD).exists():
            record = self._run(inputs, folder, [])
            if record.failure:
                raise BadInput(f"[prepare]: {record.failure}")
        for name in self.study.keeps:
            if not (folder / name).is_file():
                raise BadInput(f"study.toml: [prepare] keeps: {name} was not made by {' '.join(inputs.words)}")

    def make(self, setting, number):
        """Makes the n-th run of a setting; its Record."""
        inputs = inputs_of(self.study, setting)
        given = {}
        if self.study.prepare is not None:
            made = self.place(prepare_inputs(self.study), 1)
            given = {name: made / name for name in self.study.keeps}
        return self._run(inputs, self.place(inputs, number), [*setting.labels], given)

    def stop(self):
        """Ends the runs under way; what they wrote is dropped."""
        with self._lock:
            self._stopped = True
            for process in self._children.values():
                try:
                    os.killpg(process, signal.SIGTERM)
                except ProcessLookupError:
                    pass

    def _run(self, inputs, folder, labels, given=None):
        part = folder.with_name(folder.name + ".part")
        part.mkdir(parents=True)
        for name, content in inputs.files.items():
            (part / name).write_bytes(content)
        for name, path in (given or {}).items():
            (part / name).symlink_to(os.path.relpath(path, part))
        words = list(inputs.words)
        if self.study.ranks > 1:
            words = [*mpirun(self.study.ranks), *words]
        exit_code, processor, wall = self._timed(words, part)
        if self._stopped:
            shutil.rmtree(part)
            raise KeyboardInterrupt
        failure = ""
        if wall > self.study.time_limit:
            failure = f"stopped after {wall:.0f} s (time_limit)"
        elif exit_code != 0:
            failure = _message(part) or f"exit code {exit_code}"
        record = Record(labels, words, failure, processor, wall, self._program[1])
        (part / RECORD).write_text(json.dumps(asdict(record), indent=1) + "\n")
        part.rename(folder)
        return record

    def _timed(self, words, folder):
        """Exit code, processor and wall time (s) of a command line in a folder."""
        environment = {**os.environ, "OMP_NUM_THREADS": str(self.study.threads)}
        with open(folder / "stdout", "w") as out, open(folder / "stderr", "w") as errors:
            with self._lock:
                if self._stopped:
                    return 1, 0.0, 0.0
                start = time.monotonic()
                child = subprocess.Popen(words, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=out,
                                         stderr=errors, start_new_session=True)
                self._children[id(child)] = child.pid
            clock = threading.Timer(self.study.time_limit, os.killpg, (child.pid, signal.SIGKILL))
            clock.start()
            try:
                _, status, used = os.wait4(child.pid, 0)
            finally:
                clock.cancel()
            wall = time.monotonic() - start
            with self._lock:
                del self._children[id(child)]
        child.returncode = os.waitstatus_to_exitcode(status)
        return child.returncode, used.ru_utime + used.ru_stime, wall


def read_record(folder):
    return Record(**json.loads((folder / RECORD).read_text()))


def mpirun(ranks):
    """Command line before a program on several ranks, on machines of any size and in containers."""
    return ["mpirun", "--oversubscribe", "--allow-run-as-root", "--bind-to", "none", "-n", str(ranks)]


def program_identity(path):
    """Digest of the program file, and what it says of its version."""
    digest = hashlib.sha256(Path(path).read_bytes()).hexdigest()[:8]
    option = "--version" if Path(path).name == "granflux_cfd" else "-version"
    if not Path(path).name.startswith("granflux"):
        return digest, f"{Path(path).name}, file {digest}"
    said = subprocess.run([path, option], capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
    return digest, said.stdout.strip().split("\n")[0] or f"{Path(path).name}, file {digest}"


def _message(folder):
    """What a failed run said last: its line with ERROR, or the last line."""
    lines = [line.strip() for name in ("stdout", "stderr") for line in (folder / name).read_text(errors="replace").splitlines()]
    lines = [line for line in lines if line]
    told = ([line for line in lines if "ERROR" in line or line.startswith("granflux")] or lines or [""])[-1]
    return re.sub(r"\s*\(\S+:\d+\)$", "", told)  # not the place in the source
