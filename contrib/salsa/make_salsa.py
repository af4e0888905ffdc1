#!/usr/bin/env python3
"""Makes the salsa data set (README.md) from the takes of one couple.

    contrib/salsa/make_salsa.py --takes takes.npz --out salsa
    contrib/salsa/make_salsa.py --takes takes.npz --glitches glitches.tsv --out salsa --sheets sheets
    contrib/salsa/make_salsa.py --cmu folder --duet build/release/bin/duet --out salsa

CMU is a folder with files of the CMU motion capture database: 60.asf, 60_01.amc, ... (the lead) and
61.asf, 61_01.amc, ... (the follower). The program duet reads them. TAKES holds `lead_NN` and
`follow_NN` ([frames, joints, 3], metres, y up, one world), `joints`, `parents` and `fps`. GLITCHES
lists frames to leave out: PERSON_NN, a tab, FIRST-LAST,... below a heading. --sheets writes a
contact sheet of every class (needs python3-matplotlib).
"""

import argparse
import collections
import sys
from pathlib import Path

import numpy

from salsa import cmu, dataset_folder, moves, takes


def _print_summary(prepared):
    seconds, counts = collections.Counter(), collections.Counter()
    for take in prepared:
        for name, begin, end in moves.spans(take):
            seconds[name] += (end - begin) / take.frame_rate_hz
            counts[name] += 1
    total = sum(take.frames / take.frame_rate_hz for take in prepared)
    print(f"{len(prepared)} stretches of {len({t.name.split('_')[0] for t in prepared})} takes, "
          f"{total:.0f} s at {prepared[0].frame_rate_hz} Hz")
    for name in moves.CLASSES:
        print(f"  {name:14} {counts[name]:4} times  {seconds[name]:6.1f} s")


def _write_sheets(prepared, parents, folder):
    import matplotlib
    matplotlib.use("Agg")
    from salsa import sheet
    folder.mkdir(parents=True, exist_ok=True)
    for name in moves.CLASSES:
        sheet.draw(prepared, parents, name, folder / f"{name}.png")


def _read(options):
    """(the takes as recorded, the parents of their joints)."""
    if options.cmu:
        return cmu.read_folder(options.cmu, options.duet), list(cmu.PARENTS)
    recorded = takes.read_archive(options.takes)
    with numpy.load(options.takes) as archive:
        if "parents" not in archive:
            raise takes.TakesError(f"{options.takes}: parents: expected an array, got none")
        return recorded, [int(parent) for parent in archive["parents"]]


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--takes", type=Path, metavar="FILE.npz")
    source.add_argument("--cmu", type=Path, metavar="DIR", help="the database's own files")
    parser.add_argument("--duet", default="duet", metavar="PROGRAM", help="reads --cmu")
    parser.add_argument("--glitches", type=Path, metavar="FILE.tsv")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="a new folder")
    parser.add_argument("--sheets", type=Path, metavar="DIR")
    options = parser.parse_args(arguments)
    if options.out.exists():
        parser.error(f"--out: expected a new folder, got {options.out}, which exists")
    try:
        glitches = takes.read_glitches(options.glitches) if options.glitches else {}
        recorded, parents = _read(options)
        prepared = takes.prepare(recorded, glitches)
    except (takes.TakesError, OSError, ValueError) as error:
        print(f"make_salsa.py: {error}", file=sys.stderr)
        return 1
    if not prepared:
        print(f"make_salsa.py: expected a take of at least {takes.FEWEST_SECONDS:g} s without a "
              "glitch, got none", file=sys.stderr)
        return 1
    dataset_folder.write(prepared, parents, options.out)
    _print_summary(prepared)
    if options.sheets:
        _write_sheets(prepared, parents, options.sheets)
    return 0


if __name__ == "__main__":
    sys.exit(main())
