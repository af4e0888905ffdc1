"""``python3 -m duet_motion.sets``: what follows a run of `duet batch`, as commands."""

from __future__ import annotations

import argparse
import sys
from typing import Callable, List, Optional

from duet_motion import sets

_RETRY, _BAD_INPUT = 1, 42  # the exit codes of `duet`
_EPILOG = """Exit codes: 0 done; 1 items are missing: run duet batch again; 2 the command line is invalid;
42 the set is damaged, or is none."""


def _verify(arguments: argparse.Namespace) -> int:
    report = sets.verify(arguments.set)
    missing = "unknown how many" if report.missing is None else report.missing
    print(f"{arguments.set}: {report.items} items, {report.files} files, {len(report.problems)} problems, "
          f"{missing} items missing")
    for problem in report.problems:
        print(problem, file=sys.stderr)
    if report.problems:
        print("to make these files again, repeat the duet batch command with --verify", file=sys.stderr)
        return _BAD_INPUT
    return _RETRY if report.missing else 0


def _split(arguments: argparse.Namespace) -> int:
    counts = sets.split(arguments.set, validation=arguments.validation, test=arguments.test)
    print(", ".join(f"{name} {count}" for name, count in counts.items()))
    return 0


def _pack(arguments: argparse.Namespace) -> int:
    names = sets.pack(arguments.set, arguments.out, kind=arguments.kind, shard_bytes=arguments.shard_bytes)
    print(f"{arguments.out}: {len(names)} shards")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m duet_motion.sets", epilog=_EPILOG,
                                     description="Verifies, splits and packs data sets of duet batch.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    def add(name: str, run: Callable[[argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
        command = commands.add_parser(name, help=text, description=text)
        command.add_argument("set", help="folder of the data set")
        command.set_defaults(run=run)
        return command

    add("verify", _verify, "Compare every file with its recorded digest")
    command = add("split", _split, "Divide the items by leader: writes splits.json")
    for share in ("--validation", "--test"):
        command.add_argument(share, type=float, default=0.0, metavar="SHARE", help="share of leaders")
    command = add("pack", _pack, "Write the set as shards into a new folder")
    command.add_argument("out", help="the new folder")
    command.add_argument("--kind", choices=("npz", "tar"), default="npz",
                         help="arrays for numpy.load, or WebDataset's tar files (default: npz)")
    command.add_argument("--shard-bytes", type=int, default=256 << 20, metavar="BYTES",
                         help="maximum bytes of motion in a shard (default: 256 MiB)")
    return parser


def main(words: Optional[List[str]] = None) -> int:
    """Returns the exit code."""
    arguments = _parser().parse_args(words)
    try:
        return int(arguments.run(arguments))
    except (ImportError, OSError, ValueError) as error:
        print(f"duet_motion.sets: {error}", file=sys.stderr)
        return _BAD_INPUT


if __name__ == "__main__":
    sys.exit(main())
