# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The program granflux_study: options, order of work, exit code."""

import argparse
import fcntl
import os
import signal
import sys
import time
from pathlib import Path

from granflux_study.advice import front_of, next_try, sentence
from granflux_study.bad_input import BadInput
from granflux_study.case import FINEST, program_path, read_study
from granflux_study.csv_table import write_csv
from granflux_study.errors import Errors
from granflux_study.measured import measured
from granflux_study.progress import duration, make_missing
from granflux_study.recommend import TRIES
from granflux_study.runs import Runs
from granflux_study.settings import Setting, named, one_by_one, setting_of

DONE, STOPPED, BAD_INPUT = 0, 1, 2


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise BadInput(message)


def parser():
    p = Parser(prog="granflux_study", description="Runs a case over ladders of settings and says what accuracy costs: "
               "error and processor time of each, their Pareto front, and the quickest settings for a wanted error. "
               "Exit code: 0 done, 1 stopped, 2 bad input.")
    p.add_argument("case", help="folder with a file study.toml")
    p.add_argument("--error", action="append", default=[], type=_share, metavar="SHARE",
                   help="wanted error, such as 0.05 for 5 %%: combinations of settings are run until one keeps it; may be repeated")
    p.add_argument("--quantity", action="append", default=[], metavar="NAME",
                   help="the wanted error is of this quantity only; may be repeated (default: all that the case judges)")
    p.add_argument("--jobs", type=_count, metavar="N", help="runs at a time (default: cores over ranks times threads of a run)")
    p.add_argument("--out", type=Path, metavar="DIR", help="folder of results (default: results in the case)")
    p.add_argument("--check", action="store_true", help="checks study.toml, lists the runs that are missing, and runs nothing")
    p.add_argument("--any-version", action="store_true", help="takes runs that another build of the program has made")
    return p


def main(words, out=None):
    out = out or sys.stdout
    for asked_to_end in (signal.SIGINT, signal.SIGTERM):  # also where a shell has set them aside
        signal.signal(asked_to_end, _stop)
    try:
        return run(parser().parse_args(words), lambda line: print(line, file=out, flush=True))
    except BadInput as problem:
        print(f"granflux_study: {problem}", file=sys.stderr)
        return BAD_INPUT
    except BrokenPipeError:
        sys.stdout = open(os.devnull, "w")  # nobody listens any more; nor shall the interpreter complain at its end
        return STOPPED
    except KeyboardInterrupt:
        print("granflux_study: stopped; the runs that are complete are kept, the same command goes on", file=sys.stderr)
        return STOPPED


def _stop(_signal, _frame):
    raise KeyboardInterrupt


def run(options, say):
    study = read_study(options.case)
    for name in options.quantity:
        if name not in [q.name for q in study.quantities]:
            raise BadInput(f"--quantity {name}: must be one of {', '.join(q.name for q in study.quantities)}")
    if study.ranks > 1:
        program_path("mpirun")
    results = options.out or study.folder / "results"
    results.mkdir(parents=True, exist_ok=True)
    with open(results / "lock", "w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise BadInput(f"{results}: another granflux_study is at work there") from None
        return _study(study, results, options, say)


def _study(study, results, options, say):
    runs = Runs(study, results, options.any_version)
    jobs = options.jobs or max(1, len(os.sched_getaffinity(0)) // (study.ranks * study.threads))
    settings = _settings(study)
    startup = [Setting(setting_of(study, {}).labels, startup=True)] if study.startup else []
    name_of = lambda setting: named(study, setting)  # noqa: E731
    if options.check:
        missing = [(s, len(runs.missing(s))) for s in startup + settings if runs.missing(s)]
        say(f"{study.title}: {sum(n for _, n in missing)} runs to make, {jobs} at a time")
        for setting, count in missing:
            say(f"  {name_of(setting)}" + (f", {count} times" if count > 1 else ""))
        return DONE
    start = time.monotonic()
    runs.prepare()
    # The base alone first: where it fails, the case is wrong, not a setting.
    base = setting_of(study, {})
    make_missing(study, runs, [base], jobs, name_of, say)
    for _, record in runs.records(base):
        if record.failure:
            raise BadInput(f"the base setting does not run: {record.failure} (in {runs.records(base)[0][0]})")
    make_missing(study, runs, startup + settings, jobs, name_of, say)
    known = [s for s in sorted(map(tuple, runs.known())) if _valid(study, s)]
    settings += [s for s in (Setting(labels) for labels in known) if s not in settings and not runs.missing(s)]
    errors = _measure(study, runs, settings, startup)
    for wanted in options.error:
        for _ in range(TRIES):
            setting = next_try(study, errors, settings, wanted, options.quantity)
            if setting is None:
                break
            make_missing(study, runs, [setting], jobs, name_of, say)
            settings.append(setting)
            errors = _measure(study, runs, settings, startup)
    advice = [sentence(study, errors, settings, wanted, options.quantity) for wanted in options.error]
    front = front_of(errors, settings)
    write_csv(results / "study.csv", study, errors, settings, front)
    from granflux_study.report import write_report  # starts matplotlib

    write_report(results, study, errors, settings, front, advice)
    for line in advice:
        say(line)
    say(f"{results / 'report.html'}, study.csv, figures; {len(settings)} settings, {duration(time.monotonic() - start)}")
    return DONE


def _settings(study):
    """All that are to be run: one knob at a time, and the reference if it is a run of its own."""
    out = one_by_one(study)
    if study.reference != FINEST and any(q.right is None for q in study.quantities):
        reference = setting_of(study, study.reference)
        if reference not in out:
            out.append(reference)
    return out


def _valid(study, labels):
    return len(labels) == len(study.knobs) and all(
        label in [level.label for level in knob.levels] for knob, label in zip(study.knobs, labels))


def _measure(study, runs, settings, startup):
    off = (0.0, 0.0)
    if startup:
        records = [record for _, record in runs.records(startup[0])]
        if records[0].failure:
            raise BadInput(f"[run] startup: {records[0].failure}")
        off = (min(r.processor_time for r in records), min(r.wall_time for r in records))
    errors = Errors(study, {s: measured(study, runs, s, off) for s in settings})
    for setting in errors.right_settings(study.knobs):
        if errors.measured[setting].failure and any(q.right is None for q in study.quantities):
            raise BadInput(f"{named(study, setting)} is what others are compared with, and fails: {errors.measured[setting].failure}")
    return errors


def _share(text):
    value = float(text)
    if not 0 < value < 10:
        raise argparse.ArgumentTypeError(f"{text}: must be a share, such as 0.05 for 5 %")
    return value


def _count(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text}: must be 1 or more")
    return value
