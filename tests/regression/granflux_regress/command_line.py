# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The program granflux-regress: options, order of work, exit code."""

import argparse
import sys

from granflux_regress import particle_report, statistics_report
from granflux_regress.bad_input import BadInput
from granflux_regress.bed_statistics import AXES, CONTACTS, StatisticsOptions
from granflux_regress.compare import Comparison, Keys
from granflux_regress.dump import read_dump
from granflux_regress.matching import matched
from granflux_regress.tolerance import parse_tolerance

EQUAL, DIFFERS, BAD_INPUT = 0, 1, 2


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise BadInput(message)


def parser():
    p = Parser(
        prog="granflux-regress",
        description="Compares two dumps of LIGGGHTS or LAMMPS (styles custom and local, text, plain "
        "or .gz). Exit code: 0 equal within tolerance, 1 differs, 2 bad input.",
    )
    p.add_argument("reference", help="dump that is taken as right")
    p.add_argument("dump", help="dump that is judged")
    p.add_argument("--default", default="1e-10", metavar="REL[,ABS]",
                   help="tolerance of every column not named by --tolerance (default %(default)s); whole "
                        "numbers such as type must be equal")
    p.add_argument("--tolerance", action="append", default=[], metavar="NAME=REL[,ABS]",
                   help="tolerance of one column, vector (x v omega f torque ...) or statistic; may be repeated")
    p.add_argument("--vector", action="append", default=[], metavar="NAME=A,B,...",
                   help="columns that are the components of one vector; may be repeated")
    p.add_argument("--ignore", action="append", default=[], metavar="COLUMN[,...]",
                   help="columns that are not read; may be repeated")
    p.add_argument("--key", default="id", metavar="COLUMN[,COLUMN]",
                   help="column that names a particle, or the two that name a contact (default %(default)s)")
    p.add_argument("--odd", default="", metavar="COLUMN[,...]",
                   help="columns that change sign where the two partners of a contact change places")
    p.add_argument("--step", metavar="N[,...]", help="compares these time steps only")
    p.add_argument("--verbose", action="store_true", help="shows every quantity, not only the worst")
    s = p.add_argument_group("statistics, for runs that have become chaotic")
    s.add_argument("--statistics", action="store_true",
                   help="compares energies, centre of mass, bed height and coordination number")
    s.add_argument("--average", action="store_true", help="compares the mean over all snapshots, not each")
    s.add_argument("--up", choices=AXES, default="z", help="direction of the height (default %(default)s)")
    s.add_argument("--floor", type=float, metavar="M", help="where heights start (default: lower end of the box)")
    s.add_argument("--density", type=float, metavar="KG/M3", help="of the particles, for dumps without mass or density")
    s.add_argument("--contacts", default=CONTACTS, metavar="COLUMN",
                   help="column with the number of contacts (default %(default)s, if there)")
    return p


def main(words, out=None):
    out = out or sys.stdout
    try:
        return run(parser().parse_args(words), out)
    except BadInput as problem:
        print(f"granflux-regress: {problem}", file=sys.stderr)
        return BAD_INPUT


def run(options, out):
    steps = _steps(options.step)
    ignored = _words(options.ignore)
    snapshots = (read_dump(path, ignored, steps) for path in (options.reference, options.dump))
    missing_steps = []
    pairs = matched(*snapshots, missing_steps)
    if options.statistics:
        settings = StatisticsOptions(options.up, options.floor, options.density, options.contacts)
        equal = statistics_report.report(pairs, settings, options.tolerance, options.average,
                                         missing_steps, out)
    else:
        if options.average:
            raise BadInput("--average belongs to --statistics")
        comparison = Comparison(parse_tolerance(options.default, "--default"), options.tolerance,
                                _vectors(options.vector), _keys(options.key, options.odd))
        for a, b in pairs:
            comparison.add(a, b)
        comparison.messages += missing_steps
        equal = particle_report.report(comparison, options.verbose, out)
    return EQUAL if equal else DIFFERS


def _words(texts):
    return [word for text in texts for word in text.split(",") if word]


def _steps(text):
    if text is None:
        return None
    words = text.split(",")
    if not all(word.isdigit() for word in words):
        raise BadInput(f"--step {text}: write time steps, separated by commas")
    return {int(word) for word in words}


def _keys(key, odd):
    columns = tuple(_words([key]))
    if len(columns) not in (1, 2):
        raise BadInput(f"--key {key}: one column, or the two that name a contact")
    if odd and len(columns) == 1:
        raise BadInput("--odd is for contacts: --key must name two columns")
    return Keys(columns, tuple(_words([odd])))


def _vectors(texts):
    vectors = {}
    for text in texts:
        name, equals, members = text.partition("=")
        if not equals or not _words([members]):
            raise BadInput(f"--vector {text}: write NAME=COLUMN,COLUMN,...")
        vectors[name] = tuple(_words([members]))
    return vectors
