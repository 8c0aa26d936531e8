# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""granflux-regress on mutations of good dumps, the same ones for the same seed: it compares them with the good one or
says what is wrong with them (BadInput), and nothing else happens.

Usage: fuzz_dump.py CORPUS COUNT [SEED]
"""

import gzip
import io
import pathlib
import random
import signal
import sys
import tempfile
import warnings

from granflux_regress.command_line import main as regress

LONGEST = 10  # s an input
WORDS = [b"nan", b"-1", b"0", b"1e308", b"inf", b"99999999999", b"ITEM: ATOMS id", b"ITEM: TIMESTEP\n", b"\n", b" ", b"\0", b"\xff"]


def mutated(rng, inputs):
    """One to four changes: bits, pieces cut out, doubled, overwritten or taken from another input."""
    data = bytearray(rng.choice(inputs))
    for _ in range(rng.randint(1, 4)):
        if not data:
            break
        first = rng.randrange(len(data))
        end = first + rng.choice((1, 4, 16, 64))
        change = rng.randrange(6)
        if change == 0:
            data[first] ^= 1 << rng.randrange(8)
        elif change == 1:
            del data[first:end]
        elif change == 2:
            data[first:first] = data[first:end]
        elif change == 3:
            data[first:first] = rng.choice(WORDS)
        elif change == 4:
            data[first:end] = rng.choice(WORDS)
        else:
            other = rng.choice(inputs)
            at = rng.randrange(len(other))
            data[first:end] = other[at:at + 64]
    return bytes(data)


def main(corpus, count, seed=1):
    files = sorted(pathlib.Path(corpus).iterdir())
    inputs = [file.read_bytes() for file in files]
    rng = random.Random(int(seed))
    codes = {0: 0, 1: 0, 2: 0}  # equal, differs, bad input
    with tempfile.TemporaryDirectory() as folder:
        for i in range(-len(files), int(count)):
            data = inputs[i] if i < 0 else mutated(rng, inputs)
            zipped = i >= 0 and rng.random() < 0.1
            path = pathlib.Path(folder, "dump.gz" if zipped else "dump")
            path.write_bytes(mutated(rng, [gzip.compress(data)]) if zipped else data)
            good = str(files[i % len(files)])
            words = [good, str(path)] + (["--statistics"] if rng.random() < 0.3 else [])
            signal.alarm(LONGEST)
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("error")
                    codes[regress(words, io.StringIO())] += 1
            except BaseException:
                print(f"input {i} of seed {seed}, {words[2:]}:", data, sep="\n")
                raise
            signal.alarm(0)
    print(f"{codes[0]} equal, {codes[1]} different, {codes[2]} refused")
    return 0 if codes[0] >= len(files) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
