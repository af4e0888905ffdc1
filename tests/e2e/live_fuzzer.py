#!/usr/bin/env python3
"""Fuzzes live sessions of a running duet-server, as sequences of valid messages and single wrong ones.

    tests/e2e/live_fuzzer.py BUILD                      30 seconds with a seed of its own
    tests/e2e/live_fuzzer.py BUILD --seconds 600 --seed 7
    tests/e2e/live_fuzzer.py BUILD --seed 7 --from 120 --rounds 8 --repeat 50
    tests/e2e/live_fuzzer.py BUILD --replay out/live/plans.json

Each round plays several plans (live_fuzz/plans.py) at the same time: sessions at every rate, unit and model, in
messages of every size, with changes of labels, gaps, repeated frames, made-up histories, cancellations and messages
that must be refused. The same session must have the same frames again, also if it is interrupted and resumed with its
whole history. Meanwhile the server must stay well, as in wire_fuzzer.py. docs/fuzzing.md has more.

Exit status: 0 if nothing was found, 1 if something was: the plans of the last round are then in OUT/plans.json.
"""

import argparse
import collections
import json
import os
import pathlib
import secrets
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SHOWN_LINES = 60
REPORT_SECONDS = 10  # in which a server that is ending has written its report


def read_arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path, help="build folder, such as build/release")
    parser.add_argument("--server", type=pathlib.Path, help="program; BUILD/bin/duet-server if absent")
    parser.add_argument("--seconds", type=float, default=30, help="time after which no further round begins")
    parser.add_argument("--seed", type=int, help="of the plans; printed if absent")
    parser.add_argument("--from", type=int, default=0, dest="first", metavar="ROUND",
                        help="number of the first round to play")
    parser.add_argument("--rounds", type=int, help="how many to play, whatever --seconds")
    parser.add_argument("--together", type=int, default=4, help="plans that are played at the same time")
    parser.add_argument("--replay", type=pathlib.Path, help="play the plans of this file instead, as one round")
    parser.add_argument("--repeat", type=int, default=1, help="times to play --rounds or --replay")
    parser.add_argument("--memory", type=int, default=600, help="most MiB that the server may use")
    parser.add_argument("--patience", type=float, default=120,
                        help="seconds after which a session without an end counts as hung")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "out/live",
                        help="folder for the plans that broke something")
    return parser.parse_args(words)


def chosen_rounds(arguments, seed):
    """The rounds to play, as (number, plans)."""
    def plans_of(number):
        first = number * arguments.together
        return [plans.plan(seed, index) for index in range(first, first + arguments.together)]
    if arguments.replay:
        kept = json.loads(arguments.replay.read_text(encoding="utf-8"))["plans"]
        yield from [(0, kept)] * arguments.repeat
        return
    if arguments.rounds is not None:
        for _ in range(arguments.repeat):
            for number in range(arguments.first, arguments.first + arguments.rounds):
                yield number, plans_of(number)
        return
    end = time.monotonic() + arguments.seconds
    number = arguments.first
    while time.monotonic() < end:
        yield number, plans_of(number)
        number += 1


class Fuzzing:
    """One server from its start to its end, and the sessions with it. `counts`: what was played."""

    def __init__(self, arguments, seed):
        self._arguments = arguments
        self._seed = seed
        self._round = (arguments.first, [])
        self.counts = collections.Counter()

    def run(self):
        """Raises Finding with what the server did wrong."""
        self.target = target.Target(self._arguments.server, flags=())
        try:
            self._play_all()
        except (OSError, AssertionError, live_clients.grpc.RpcError, judge.Finding) as error:
            self._explain(error)
        finally:
            self.target.kill()

    def _play_all(self):
        health = judge.Judge(self.target.server, [], self._arguments.memory, self._arguments.patience)
        players = []
        for _ in range(self._arguments.together):
            channel = live_clients.grpc.insecure_channel(
                self.target.server.address, options=(("grpc.use_local_subchannel_pool", 1),))
            models = player.models_of(channel, plans.CLASSES, self._arguments.patience)
            players.append(player.Player(channel, models, self._arguments.patience))
        for self._round in chosen_rounds(self._arguments, self._seed):
            found = tools.together([lambda of=of: self._judged(*of) for of in zip(players, self._round[1])])
            health.check_probes()
            health.check_memory()
            self.counts["rounds"] += 1
            if any(found):
                raise judge.Finding("\n".join(filter(None, found)))
        health.check_no_call_is_left()
        health.check_probes()
        self.target.stop()

    def _judged(self, one, made):
        """Plays a plan up to the first finding; returns what is wrong. Exceptions of a thread would be lost."""
        try:
            what = next(filter(None, self._play(one, made)), None)
        except Exception as error:  # pylint: disable=broad-except
            what = repr(error)
        return what and f"{what}\nplan: {json.dumps(made)}"

    def _play(self, one, made):
        whole = self._counted(one.play(made))
        yield verdicts.of_answer(made, whole)
        for _ in range(made["repeats"] - 1):
            again = self._counted(one.play(made))
            yield verdicts.of_answer(made, again)
            if verdicts.can_compare(whole, again):
                self.counts["comparisons"] += 1
                yield verdicts.of_repeat(whole, again)
        if not verdicts.can_compare(whole):
            return
        for at in made["resumes"]:
            rest = one.resume(made, whole, at)
            if rest is None:
                continue
            self._counted(rest)
            for what in (verdicts.of_answer(made, rest),
                         verdicts.of_resumed(whole, rest) if verdicts.can_compare(rest) else None):
                yield what and f"{what}; resumed: {at}"
            self.counts["comparisons"] += verdicts.can_compare(rest)

    def _counted(self, answer):
        self.counts["sessions"] += 1
        self.counts["frames"] += len(answer.frames)
        self.counts["refused"] += answer.code in verdicts.COME_AGAIN
        return answer

    def _explain(self, error):
        """Raises what was found, with the server's end, and keeps the plans of the round."""
        server = self.target.server
        code = server.exit_code(REPORT_SECONDS)
        state = "goes on" if code is None else f"ended with {code}"
        number, played = self._round
        self._arguments.out.mkdir(parents=True, exist_ok=True)
        path = self._arguments.out / "plans.json"
        path.write_text(json.dumps({"seed": self._seed, "round": number, "plans": played}, indent=1), encoding="utf-8")
        raise judge.Finding("".join((
            f"{error}; the server {state}\n", *self.target.complaints()[:SHOWN_LINES],
            f"round {number}, kept in {path}\n"
            f"repeat: live_fuzzer.py {self._arguments.build} --replay {path}, or --seed {self._seed} "
            f"--from {number} --rounds 1"
        ))) from error


def main(words=None):
    arguments = read_arguments(words)
    seed = secrets.randbelow(2**31) if arguments.seed is None else arguments.seed
    print(f"live fuzzer: seed {seed}", flush=True)
    fuzzing = Fuzzing(arguments, seed)
    try:
        fuzzing.run()
    except judge.Finding as finding:
        print(f"FOUND: {finding}", flush=True)
        return 1
    counts = fuzzing.counts
    print(f"{counts['rounds']} rounds, {counts['sessions']} sessions with {counts['frames']} frames, "
          f"{counts['comparisons']} comparisons, {counts['refused']} sessions without a place, stopped with 0",
          flush=True)
    return 0


if __name__ == "__main__":
    os.environ.setdefault("DUET_SOURCE_DIR", str(SOURCE))
    os.environ.setdefault("DUET_BIN_DIR", str(read_arguments().build.resolve() / "bin"))
import live_clients  # noqa: E402
import tools  # noqa: E402
from live_fuzz import player, plans, verdicts  # noqa: E402
from wire import judge, target  # noqa: E402

if __name__ == "__main__":
    sys.exit(main())
