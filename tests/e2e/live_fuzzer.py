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

import collections
import json
import sys

import fuzzing

PARSER = fuzzing.make_parser(__doc__, "live/plans.json", patience=120)
PARSER.add_argument("--together", type=int, default=4, help="plans that are played at the same time")
if __name__ == "__main__":
    fuzzing.set_environment(PARSER)

import live_clients  # noqa: E402
import tools  # noqa: E402
from live_fuzz import plans, player, verdicts  # noqa: E402
from wire import judge, target  # noqa: E402


class Fuzzing:
    """One server from its start to its end, and the sessions with it. `counts`: what was played."""

    def __init__(self, arguments, seed):
        self._arguments = arguments
        self._seed = seed
        self._round = (arguments.first, [])
        self.counts = collections.Counter()

    def run(self):
        """Returns a summary; raises Finding with what the server did wrong."""
        self.target = target.Target(self._arguments.server, flags=())
        try:
            self._play_all()
        except (OSError, AssertionError, live_clients.grpc.RpcError, fuzzing.Finding) as error:
            number, played = self._round
            fuzzing.explain(error, self.target, "live", self._arguments, self._seed, [number], lambda path: path.write_text(
                json.dumps({"seed": self._seed, "round": number, "plans": played}, indent=1), encoding="utf-8"))
        finally:
            self.target.kill()
        counts = self.counts
        return (f"{counts['rounds']} rounds, {counts['sessions']} sessions with {counts['frames']} frames, "
                f"{counts['comparisons']} comparisons, {counts['refused']} sessions without a place, stopped with 0")

    def _plans_of(self, number):
        first = number * self._arguments.together
        return [plans.plan(self._seed, index) for index in range(first, first + self._arguments.together)]

    def _play_all(self):
        health = judge.Judge(self.target.server, [], self._arguments.memory, self._arguments.patience)
        players = []
        for _ in range(self._arguments.together):
            channel = live_clients.grpc.insecure_channel(
                self.target.server.address, options=(("grpc.use_local_subchannel_pool", 1),))
            models = player.models_of(channel, plans.CLASSES, self._arguments.patience)
            players.append(player.Player(channel, models, self._arguments.patience))
        replay = self._arguments.replay
        kept = [json.loads(replay.read_text(encoding="utf-8"))["plans"]] if replay else None
        for self._round in fuzzing.chosen_rounds(self._arguments, self._plans_of, kept):
            found = tools.together([lambda of=of: self._judged(*of) for of in zip(players, self._round[1])])
            health.check_probes()
            health.check_memory()
            self.counts["rounds"] += 1
            if any(found):
                raise fuzzing.Finding("\n".join(filter(None, found)))
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


def main(words=None):
    return fuzzing.main("live", PARSER.parse_args(words), lambda arguments, seed: Fuzzing(arguments, seed).run())


if __name__ == "__main__":
    sys.exit(main())
