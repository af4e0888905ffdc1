#!/usr/bin/env python3
r"""Makes the data sets of everyday interactions (README.md) from archives of captured people.

    contrib/everyday/make_everyday.py --trials trials.npz --glitches glitches.tsv \\
      --single single.npz --table single.tsv --out everyday

TRIALS holds `a_SS_TT` and `b_SS_TT` ([frames, joints, 3], metres, y up, one world), `joints`,
`parents` and `fps`; SINGLE holds one array a motion, and TABLE its class. Writes two folders:
OUT/first, the pairs and others staged from all single people, for a first run of the training;
OUT/second, the pairs and a part of the staged ones.
"""

import argparse
import collections
import csv
import dataclasses
import sys
from pathlib import Path

from everyday import captures, dataset_folder, staged

STRETCHES = Path(__file__).with_name("stretches.tsv")
# First seconds of the staged pairs; of these, the second run has one in so many. Captured trials are
# written as often as it takes for each class to have so many windows of the training (2 s, every .5 s).
FIRST_SECONDS, STAGED_SECONDS, STAGED_PART = 8.0, 4.0, 4
CLASS_WINDOWS, WINDOW_SECONDS, STRIDE_SECONDS = 96, 2.0, 0.5


def _print_summary(title, pairs):
    seconds, counts = collections.Counter(), collections.Counter()
    for pair in pairs:
        for name, begin, end in pair.spans:
            seconds[name] += end - begin
            counts[name] += 1
    print(f"{title}: {len(pairs)} pairs, {sum(pair.seconds for pair in pairs):.0f} s at "
          f"{captures.FRAME_RATE_HZ} Hz")
    for name in dataset_folder.CLASSES:
        print(f"  {name:10} {counts[name]:4} times  {seconds[name]:6.1f} s")


def _single_classes(path):
    """{key: class} of the single people who are not half of a pair."""
    with open(path, encoding="utf-8", newline="") as file:
        return {row["key"]: row["class"] for row in csv.DictReader(file, delimiter="\t")
                if row.get("pair_trial") != "yes"}


def _copies(captured):
    """The pairs as often as their classes need them, so that classes of few and short trials count."""
    trials = collections.Counter(pair.spans[0][0] for pair in captured
                                 if captures.LEFT_OUT not in pair.subjects)
    copies = []
    for pair in captured:
        windows = 1 + max(0, int((pair.seconds - WINDOW_SECONDS) / STRIDE_SECONDS))
        count = -(-CLASS_WINDOWS // trials[pair.spans[0][0]] // windows)
        for i in range(1 if captures.LEFT_OUT in pair.subjects else count):
            copies.append(dataclasses.replace(pair, name=pair.name + (f"_copy{i + 1}" if i else "")))
    return copies


def _beginning(pair, seconds):
    frames = round(seconds * captures.FRAME_RATE_HZ)
    people = tuple(person[:frames] for person in pair.people)
    spans = tuple((name, begin, min(end, seconds)) for name, begin, end in pair.spans)
    return dataclasses.replace(pair, people=people, spans=spans)


def _make(options):
    trials, single = (captures.read_archive(path) for path in (options.trials, options.single))
    glitches = captures.read_glitches(options.glitches) if options.glitches else {}
    captured = captures.pairs(trials, captures.read_stretches(options.stretches), glitches)
    if not captured:
        raise captures.CaptureError(f"{trials.path}: expected a stretch of at least "
                                    f"{captures.SHORTEST_SECONDS:g} s, got none")
    classes = _single_classes(options.table)
    from_single = staged.pairs(single, classes)
    part = [_beginning(pair, STAGED_SECONDS) for pair in from_single[::STAGED_PART]]
    from_single = [_beginning(pair, FIRST_SECONDS) for pair in from_single]
    copied = _copies(captured)
    for name, pairs in (("first", copied + from_single), ("second", copied + part)):
        dataset_folder.write(pairs, trials.joints, trials.parents, captures.FRAME_RATE_HZ,
                             options.out / name)
    for title, pairs in (("captured", captured), ("first", copied + from_single),
                         ("second", copied + part)):
        _print_summary(title, pairs)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trials", type=Path, required=True, metavar="FILE.npz")
    parser.add_argument("--stretches", type=Path, metavar="FILE.tsv", default=STRETCHES,
                        help="when each class holds (default: beside this script)")
    parser.add_argument("--glitches", type=Path, metavar="FILE.tsv")
    parser.add_argument("--single", type=Path, required=True, metavar="FILE.npz")
    parser.add_argument("--table", type=Path, required=True, metavar="FILE.tsv")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="a new folder")
    options = parser.parse_args(arguments)
    if options.out.exists():
        parser.error(f"--out: expected a new folder, got {options.out}, which exists")
    try:
        _make(options)
    except (captures.CaptureError, OSError) as error:
        print(f"make_everyday.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
