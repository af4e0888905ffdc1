#!/usr/bin/env python3
"""Measures a model of everyday interactions on pairs that were left out of its training.

    contrib/everyday/measure.py --data solved --server localhost:50051 --model everyday

DATA is the data set of the training (make_everyday.py, solved). Answers each left-out leader with its
class: without a start, with the follower's first place, with its first pose, and live. Beside the model:
the captured follower, its first pose held, the mean follower of the class, and the training follower
whose leader moves most alike, chosen anew every two seconds. --films writes a film strip of each answer (needs python3-pil).
Needs the Python package duet_motion. Columns: everyday/figures.py.
"""

import argparse
import asyncio
import sys
from pathlib import Path

import numpy

from everyday import baselines, figures

LIVE_DELAY = 2       # frames
STILL_SECONDS = 8.0
STILL_FROM = 3.0     # seconds, by when the follower has come to rest
SEEDS = (0, 1, 2)


async def _follow_live(server, request, leader):
    import duet_motion as duet
    async with duet.aio.Client(server) as client:
        async with client.live_request(request) as session:
            async def play():
                clock = asyncio.get_running_loop()
                start = clock.time()
                for index, frame in enumerate(leader.positions):
                    await asyncio.sleep(start + index / leader.frame_rate_hz - clock.time())
                    await session.send(frame)
                await session.finish()
            playing = asyncio.create_task(play())
            parts = [part.positions async for part in session]
            await playing
    return numpy.concatenate(parts)


class Model:
    """A model on a server; answers are [frames, joints, 3] like the leader."""

    def __init__(self, server, name, joint_names, rate):
        import duet_motion as duet
        self._duet, self._server, self._name = duet, server, name
        self._joints, self._rate = joint_names, rate
        self._client = duet.Client(server)

    def _motion(self, leader):
        return self._duet.Motion(leader, self._joints, self._rate)

    def clip(self, leader, labels, seed, start=None, variety=1.0):
        return self._client.synthesize(self._motion(leader), labels=labels, model=self._name, seed=seed,
                                       variety=variety, follower_start=start).follower.positions

    def live(self, leader, labels, seed, start=None):
        request = self._duet.LiveRequest(self._joints, self._rate, labels, model=self._name, seed=seed,
                                         delay=LIVE_DELAY, follower_start=start)
        return asyncio.run(_follow_live(self._server, request, self._motion(leader)))


def _answers(model, pair, train, rate):
    """{row: [followers]} of a left-out pair."""
    leader, label, first = pair.leader, {pair.label: 1}, pair.follower[0]
    rows = {
        "captured": [pair.follower],
        "first pose held": [numpy.repeat(first[None], len(leader), axis=0)],
        "class mean": [baselines.class_mean(pair, train)],
    }
    for suffix, told, known in (("", None, None), ("+place", first[0], first[:1]), ("+pose", first, first)):
        rows["nearest neighbour" + suffix] = [baselines.nearest(pair, train, rate, known)]
        rows["model" + suffix] = [model.clip(leader, label, seed, told) for seed in SEEDS]
        rows[f"model{suffix}, variety 0"] = [model.clip(leader, label, 0, told, variety=0)]
    rows["model+pose, live"] = [model.live(leader, label, seed, first) for seed in SEEDS[:1]]
    return rows


def _still_figures(model, pairs, joints, rate):
    """Leaders who stand: {(row, class): [figures]} of followers without a class and with it."""
    frames, found = round(STILL_SECONDS * rate), {}
    for pair in pairs:
        leader = numpy.repeat(pair.leader[:1], frames, axis=0)
        for kind, answer in (("clip", model.clip), ("live", model.live)):
            for label, weight in (("none", 0), (pair.label, 1)):
                follower = answer(leader, {pair.label: weight}, 0)
                found.setdefault((f"still leader, {kind}", label), []).append(
                    figures.stillness(follower[round(STILL_FROM * rate):], joints, rate))
    return found


def _print(found, columns):
    print("row\tclass\t" + "\t".join(columns))
    for (row, label), some in found.items():
        mean = figures.mean(some)
        print(f"{row}\t{label}\t" + "\t".join(f"{mean[column]:.2f}" for column in columns))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, metavar="DIR")
    parser.add_argument("--server", default="localhost:50051", metavar="HOST:PORT")
    parser.add_argument("--model", default="everyday")
    parser.add_argument("--films", type=Path, metavar="DIR")
    options = parser.parse_args()
    data = baselines.read(options.data)
    model = Model(options.server, options.model, data.joint_names, data.rate)
    train = [pair for pair in data.pairs if not pair.is_left_out]
    tests = [both for pair in data.pairs if pair.is_left_out for both in pair.roles()]
    by_class = {}
    for pair in tests:
        for row, followers in _answers(model, pair, train, data.rate).items():
            for follower in followers:
                by_class.setdefault((row, pair.label), []).append(
                    figures.pair(pair.leader, follower, pair.follower, data.joint_names, data.rate))
            if options.films:
                from everyday import film
                film.write(pair.leader, followers[0], data.parents, data.rate,
                           options.films / f"{pair.label}_{pair.name}_{row.replace(' ', '_')}.png")
    _print(by_class, figures.COLUMNS)
    print()
    _print(_still_figures(model, tests, data.joint_names, data.rate), figures.STILL_COLUMNS)
    return 0


if __name__ == "__main__":
    sys.exit(main())
