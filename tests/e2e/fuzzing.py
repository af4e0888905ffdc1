"""What wire_fuzzer.py and live_fuzzer.py have in common: arguments, the rounds to play, and how a finding is reported."""

import argparse
import os
import pathlib
import secrets
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SHOWN_LINES = 60
REPORT_SECONDS = 10  # in which a server that is ending has written its report


class Finding(Exception):
    """The server broke a promise."""


def make_parser(description, kept, patience):
    """`kept`: the file below out/ for the rounds that broke something."""
    parser = argparse.ArgumentParser(description=description.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="build folder, such as build/release")
    parser.add_argument("--server", type=pathlib.Path, help="program; BUILD/bin/duet-server if absent")
    parser.add_argument("--seconds", type=float, default=30,
                        help="time after which no further round begins, systematic ones excepted")
    parser.add_argument("--seed", type=int, help="of the random rounds; printed if absent")
    parser.add_argument("--from", type=int, default=0, dest="first", metavar="ROUND",
                        help="number of the first round to play")
    parser.add_argument("--rounds", type=int, help="how many to play, whatever --seconds")
    parser.add_argument("--replay", type=pathlib.Path, help="play what this file keeps instead")
    parser.add_argument("--repeat", type=int, default=1, help="times to play --rounds or --replay")
    parser.add_argument("--memory", type=int, default=600, help="most MiB that the server may use")
    parser.add_argument("--patience", type=float, default=patience,
                        help="seconds without an answer after which the server counts as hung")
    parser.add_argument("--out", type=pathlib.Path, default=(SOURCE / "out" / kept).parent,
                        help="folder for the rounds that broke something")
    parser.set_defaults(kept=pathlib.Path(kept).name)
    return parser


def set_environment(parser):
    """For a fuzzer that runs as a program, before it imports tools."""
    os.environ.setdefault("DUET_SOURCE_DIR", str(SOURCE))
    os.environ.setdefault("DUET_BIN_DIR", str(parser.parse_args().build.resolve() / "bin"))


def chosen_rounds(arguments, round_of, kept=None, systematic=0):
    """The rounds to play, as (number, round). `round_of`: the round of a number; `kept`: those of --replay;
    `systematic`: number of the rounds that are played whatever --seconds."""
    if kept is not None or arguments.rounds is not None:
        count = len(kept) if kept is not None else arguments.rounds
        for _ in range(arguments.repeat):
            for number in range(arguments.first, arguments.first + count):
                yield number, kept[number] if kept is not None else round_of(number)
        return
    end = time.monotonic() + arguments.seconds
    number = arguments.first
    while number < systematic or time.monotonic() < end:
        yield number, round_of(number)
        number += 1


def explain(error, target, name, arguments, seed, numbers, keep):
    """Raises what was found, with the end of the target's server, after keep(path) has written the last rounds."""
    code = target.server.exit_code(REPORT_SECONDS)
    state = "goes on, hangs or misbehaves" if code is None else f"ended with {code}"
    arguments.out.mkdir(parents=True, exist_ok=True)
    path = arguments.out / arguments.kept
    keep(path)
    raise Finding("".join((
        f"{error}; the server {state}\n", *target.complaints()[:SHOWN_LINES],
        f"rounds {numbers[0]} to {numbers[-1]}, kept in {path}\n"
        f"repeat: {name}_fuzzer.py {arguments.build} --replay {path}, or --seed {seed} "
        f"--from {numbers[0]} --rounds {len(numbers)}"))) from error


def main(name, arguments, fuzz):
    """Runs fuzz(arguments, seed), which returns a summary or raises Finding; the exit status."""
    seed = secrets.randbelow(2**31) if arguments.seed is None else arguments.seed
    print(f"{name} fuzzer: seed {seed}", flush=True)
    try:
        print(fuzz(arguments, seed), flush=True)
    except Finding as finding:
        print(f"FOUND: {finding}", flush=True)
        return 1
    return 0
