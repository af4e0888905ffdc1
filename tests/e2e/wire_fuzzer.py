#!/usr/bin/env python3
"""Fuzzes a running duet-server over real sockets, with raw HTTP/2 frames.

    tests/e2e/wire_fuzzer.py BUILD                      30 seconds with a seed of its own
    tests/e2e/wire_fuzzer.py BUILD --seconds 600 --seed 7
    tests/e2e/wire_fuzzer.py BUILD --seed 7 --from 120 --rounds 8 --repeat 50
    tests/e2e/wire_fuzzer.py BUILD --replay out/wire/rounds.json

Sends every method of every service, the admin port and the metrics port requests that are empty, cut
short, repeated, mutated or framed wrongly, over several connections at a time, and cancels calls and
closes connections in between. Meanwhile and after each round it asks probes, compares good calls with
the answers that they had before, and looks at memory. At the end every call must be over, and SIGTERM
must end the server with 0. docs/fuzzing.md has more.

Exit status: 0 if nothing was found, 1 if something was: the last rounds are then in OUT/rounds.json.
"""

import argparse
import collections
import os
import pathlib
import secrets
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
KEPT_ROUNDS = 20  # those of which one or several broke the server
SHOWN_LINES = 60
REPORT_SECONDS = 10  # in which a server that is ending has written its report


def read_arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="build folder, such as build/release")
    parser.add_argument("--server", type=pathlib.Path, help="program; BUILD/bin/duet-server if absent")
    parser.add_argument("--seconds", type=float, default=30,
                        help="time after which no further round begins, the systematic ones excepted")
    parser.add_argument("--seed", type=int, help="of the random rounds; printed if absent")
    parser.add_argument("--from", type=int, default=0, dest="first", metavar="ROUND",
                        help="number of the first round to play")
    parser.add_argument("--rounds", type=int, help="how many to play, whatever --seconds")
    parser.add_argument("--replay", type=pathlib.Path, help="play the rounds of this file instead")
    parser.add_argument("--repeat", type=int, default=1, help="times to play --rounds or --replay")
    parser.add_argument("--memory", type=int, default=600, help="most MiB that the server may use")
    parser.add_argument("--patience", type=float, default=60,
                        help="seconds without an answer after which the server counts as hung")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "out/wire",
                        help="folder for the rounds that broke something")
    return parser.parse_args(words)


def chosen_rounds(arguments, rounds, saved):
    """The rounds to play, as (number, round)."""
    if arguments.replay or arguments.rounds is not None:
        count = len(saved) if arguments.replay else arguments.rounds
        for _ in range(arguments.repeat):
            for number in range(arguments.first, arguments.first + count):
                yield number, saved[number] if arguments.replay else rounds[number]
        return
    end = time.monotonic() + arguments.seconds
    number = arguments.first
    while number < rounds.systematic_count or time.monotonic() < end:
        yield number, rounds[number]
        number += 1


class Session:
    """One server from its start to its end, and what is sent to it."""

    def __init__(self, arguments, seed):
        self._arguments = arguments
        self._seed = seed
        self._played = collections.deque(maxlen=KEPT_ROUNDS)
        self.count = self.calls = self.good_calls = self.peak_mib = 0

    def run(self):
        """Raises Finding with what the server did wrong."""
        self.target = target.Target(self._arguments.server)
        try:
            self._attack()
        except (OSError, player.Unanswered, judge.Finding) as error:
            self._explain(error)
        finally:
            self.target.kill()

    def _attack(self):
        patience = self._arguments.patience
        methods = self.target.methods(patience)
        self._judge = judge.Judge(self.target.server, good_calls(methods), self._arguments.memory,
                                  patience)
        caller = judge.GoodCaller(self._judge)
        try:
            self._play_all(rounds.Rounds(self._seed, methods), caller)
        finally:
            caller.stop()
        self.good_calls = self._judge.good_calls
        self._judge.check_no_call_is_left()
        self._judge.check_probes()
        self.target.stop()

    def _play_all(self, generated, caller):
        saved = saved_rounds.read(self._arguments.replay) if self._arguments.replay else None
        one = player.Player(self.target.ports, self._arguments.patience)
        for number, connections in chosen_rounds(self._arguments, generated, saved):
            self._played.append((number, connections))
            one.play(connections)
            self._judge.check_probes()
            self._judge.check_memory()
            caller.check()
            self.count += 1
            self.calls += sum(step[0] == "send" for each in connections for step in each["steps"])
            self.peak_mib = max(self.peak_mib, self._judge.memory_mib())

    def _explain(self, error):
        """Raises what was found, with the server's end, and keeps the last rounds."""
        server = self.target.server
        code = server.exit_code(REPORT_SECONDS)
        state = "hangs or misbehaves" if code is None else f"ended with {code}"
        self._arguments.out.mkdir(parents=True, exist_ok=True)
        path = self._arguments.out / "rounds.json"
        numbers = [number for number, _ in self._played] or [self._arguments.first]
        saved_rounds.write(path, {"seed": self._seed, "numbers": numbers},
                           [connections for _, connections in self._played])
        lines = self.target.complaints()[:SHOWN_LINES]
        raise judge.Finding("".join((
            f"{error}; the server {state}\n", *lines,
            f"last rounds: {numbers[0]} to {numbers[-1]}, kept in {path}\n"
            f"repeat: wire_fuzzer.py {self._arguments.build} --replay {path}, or --seed {self._seed} "
            f"--from {numbers[0]} --rounds {len(numbers)}"
        ))) from error


def good_calls(methods):
    """Calls whose answer never changes: synthesis, the model that nobody touches, reflection."""
    requests = {method: given for _, method, given in methods}
    get_model = f"{corpus.SYNTHESIS}/GetModel"
    info = f"{corpus.REFLECTION}/ServerReflectionInfo"
    return [*((corpus.SYNTHESIZE, each) for each in requests[corpus.SYNTHESIZE]),
            (get_model, requests[get_model][0]), (info, requests[info][0])]


def main(words=None):
    arguments = read_arguments(words)
    seed = secrets.randbelow(2**31) if arguments.seed is None else arguments.seed
    print(f"wire fuzzer: seed {seed}", flush=True)
    session = Session(arguments, seed)
    try:
        session.run()
    except judge.Finding as finding:
        print(f"FOUND: {finding}", flush=True)
        return 1
    print(f"{session.count} rounds, {session.calls} pieces sent, {session.good_calls} good calls "
          f"answered as ever, {session.peak_mib} MiB at most, stopped with 0", flush=True)
    return 0


if __name__ == "__main__":
    os.environ.setdefault("DUET_SOURCE_DIR", str(SOURCE))
    os.environ.setdefault("DUET_BIN_DIR", str(read_arguments().build.resolve() / "bin"))
from wire import corpus, judge, player, rounds, target  # noqa: E402
from wire import saved as saved_rounds  # noqa: E402

if __name__ == "__main__":
    sys.exit(main())
