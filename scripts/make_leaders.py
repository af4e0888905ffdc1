#!/usr/bin/env python3
"""Makes motions of leaders without followers, for duet-train --leaders (docs/training.md).

    scripts/make_leaders.py --out leaders                 # 16 motions of 24 s
    scripts/make_leaders.py --out leaders --each 4 --seed 2 --duet-keyframe build/release/bin/duet-keyframe

Each motion is a file <kind>_<number>.bvh. The kinds are in scripts/leaders/kinds.py. The same seed
makes the same files. None of them is among the leaders that `duet-eval plausible` and `duet-eval
long` make.
"""

import argparse
import random
import subprocess
import sys
import tempfile
from pathlib import Path

from leaders import body, kinds


def key_frames(kind, seed, number, seconds):
    """The key frames of one motion, as text."""
    return body.key_frames(kind(random.Random(f"{kind.__name__} {seed} {number}"), seconds))


def make(out, each, seed, seconds, program):
    """Writes the motions below the folder `out`; returns their number."""
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        text = Path(folder) / "key_frames.txt"
        for kind in kinds.KINDS:
            for number in range(1, each + 1):
                text.write_text(key_frames(kind, seed, number, seconds), encoding="utf-8")
                subprocess.run([program, text, "--out", out / f"{kind.__name__}_{number}.bvh"],
                               check=True)
    return each * len(kinds.KINDS)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, required=True, help="folder of the motions")
    parser.add_argument("--each", type=int, default=2, help="motions of each kind")
    parser.add_argument("--seconds", type=float, default=24, help="length of a motion, at most 60")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--duet-keyframe", default="duet-keyframe", help="the program")
    arguments = parser.parse_args()
    if not 5 <= arguments.seconds <= 60:
        sys.exit(f"make_leaders: --seconds: expected 5 to 60, got {arguments.seconds:g}")
    if arguments.each < 1:
        sys.exit(f"make_leaders: --each: expected at least 1, got {arguments.each}")
    count = make(arguments.out, arguments.each, arguments.seed, arguments.seconds,
                 arguments.duet_keyframe)
    print(f"{count} motions in {arguments.out}")


if __name__ == "__main__":
    main()
