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

import collections
import sys

import fuzzing

KEPT_ROUNDS = 20  # those of which one or several broke the server
PARSER = fuzzing.make_parser(__doc__, "wire/rounds.json", patience=60)
if __name__ == "__main__":
    fuzzing.set_environment(PARSER)

from wire import corpus, judge, player, rounds, saved, target  # noqa: E402


class Session:
    """One server from its start to its end, and what is sent to it."""

    def __init__(self, arguments, seed):
        self._arguments = arguments
        self._seed = seed
        self._played = collections.deque(maxlen=KEPT_ROUNDS)
        self.count = self.calls = self.good_calls = self.peak_mib = 0

    def run(self):
        """Returns a summary; raises Finding with what the server did wrong."""
        self.target = target.Target(self._arguments.server)
        try:
            self._attack()
        except (OSError, player.Unanswered, fuzzing.Finding) as error:
            numbers = [number for number, _ in self._played] or [self._arguments.first]
            fuzzing.explain(error, self.target, "wire", self._arguments, self._seed, numbers, lambda path: saved.write(
                path, {"seed": self._seed, "numbers": numbers}, [connections for _, connections in self._played]))
        finally:
            self.target.kill()
        return (f"{self.count} rounds, {self.calls} pieces sent, {self.good_calls} good calls "
                f"answered as ever, {self.peak_mib} MiB at most, stopped with 0")

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
        kept = saved.read(self._arguments.replay) if self._arguments.replay else None
        one = player.Player(self.target.ports, self._arguments.patience)
        for number, connections in fuzzing.chosen_rounds(
                self._arguments, generated.__getitem__, kept, generated.systematic_count):
            self._played.append((number, connections))
            one.play(connections)
            self._judge.check_probes()
            self._judge.check_memory()
            caller.check()
            self.count += 1
            self.calls += sum(step[0] == "send" for each in connections for step in each["steps"])
            self.peak_mib = max(self.peak_mib, self._judge.memory_mib())


def good_calls(methods):
    """Calls whose answer never changes: synthesis, the model that nobody touches, reflection."""
    requests = {method: given for _, method, given in methods}
    get_model = f"{corpus.SYNTHESIS}/GetModel"
    info = f"{corpus.REFLECTION}/ServerReflectionInfo"
    return [*((corpus.SYNTHESIZE, each) for each in requests[corpus.SYNTHESIZE]),
            (get_model, requests[get_model][0]), (info, requests[info][0])]


def main(words=None):
    return fuzzing.main("wire", PARSER.parse_args(words), lambda arguments, seed: Session(arguments, seed).run())


if __name__ == "__main__":
    sys.exit(main())
