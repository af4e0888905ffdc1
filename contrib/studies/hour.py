#!/usr/bin/env python3
"""Measures whether live followers keep posture and place for an hour (README.md).

    contrib/studies/hour.py samples/hug.bvh --minutes 60
"""

import argparse
import asyncio

import numpy as np
import people

import duet_motion as duet

NEAREST, FARTHEST = 0.15, 2.75  # metres that a follower should keep from its leader
CLASS_SECONDS, TELEPORT_SECONDS, TELEPORT_METRES = 60, 5, 2
BLOCK_SECONDS = 1  # of leader frames at a time; the session waits for the answers to ten of them


def to_and_fro(positions, frames, step=1):
    """The motion forwards and backwards, `step` frames at a time: endless without a jump."""
    phase = np.arange(frames) * step % max(1, 2 * len(positions) - 2)
    return positions[np.minimum(phase, 2 * len(positions) - 2 - phase)]


def leaders(motion, seconds, seed=0):
    """Four leaders of that length by name. Shapes: [frames, joints, 3] each."""
    random = np.random.default_rng(seed)
    frames = round(seconds * motion.frame_rate_hz)
    absent = []
    while sum(map(len, absent)) < frames:
        playing = to_and_fro(motion.positions, round(random.uniform(2, 8) * motion.frame_rate_hz))
        pause = round(np.exp(random.uniform(np.log(0.1), np.log(30))) * motion.frame_rate_hz)
        absent += [playing, np.repeat(playing[-1:], pause, axis=0)]
    places = random.uniform(-TELEPORT_METRES, TELEPORT_METRES, (int(seconds // TELEPORT_SECONDS) + 1, 1, 3))
    places[:, :, 1] = 0
    place = (np.arange(frames) / motion.frame_rate_hz // TELEPORT_SECONDS).astype(int)
    return {"idle": np.repeat(motion.positions[:1], frames, axis=0),
            "wild": to_and_fro(motion.positions, frames, step=2),
            "absent": np.concatenate(absent)[:frames],
            "teleporting": to_and_fro(motion.positions, frames) + places[place]}


async def answer(client, model, motion, leader, classes, delay):
    """The follower of a live session. Shapes: leader and result [frames, joints, 3]."""
    rate = motion.frame_rate_hz
    minutes = range(0, len(leader), round(CLASS_SECONDS * rate))
    # The first and the last minute have the same class.
    names = [classes[n % len(classes)] if n + 1 < len(minutes) else classes[0] for n in range(len(minutes))]
    labels = {}
    for frame, name in zip(minutes, names):
        if frame > 0:
            labels[frame - 1] = labels[max(labels)]
        labels[frame] = {name: 1}
    parts = []
    async with client.live(motion.joint_names, rate, keyframes=labels, delay=delay, model=model) as session:
        async def play():
            block = max(1, round(BLOCK_SECONDS * rate))
            for first in range(0, len(leader), block):
                await session.send(leader[first:first + block])
            await session.finish()
        playing = asyncio.create_task(play())
        async for part in session:
            parts.append(part.positions)
        await playing
    return np.concatenate(parts)


def measure(leader, follower, names, rate):
    """A row of the table."""
    second, minute = max(1, round(rate)), round(60 * rate)
    lean = np.convolve(people.lean_degrees(follower, names), np.ones(second) / second, "valid")
    apart = people.root_distance(leader, follower, names)
    foot = follower[:, people.joints(names, "_ankle", "_foot"), 1].min(axis=1)
    first, last = (people.joint_speed(part, rate) for part in (follower[:minute], follower[-minute:]))
    return (lean.max(), apart.min(), apart.max(), float(((apart < NEAREST) | (apart > FARTHEST)).mean()),
            float(np.quantile(np.abs(foot - np.median(foot)), 0.99)), first, last, last / first)


async def run(options):
    motion = duet.read_motion(options.leader)
    rows = []
    async with duet.aio.Client(options.server) as client:
        model = await client.get_model(options.model)
        motion = motion.select(model.model.joint_names)
        for name, leader in leaders(motion, 60 * options.minutes).items():
            follower = await answer(client, options.model, motion, leader, model.model.interaction_classes,
                                    options.delay)
            rows.append((name, measure(leader, follower, motion.joint_names, motion.frame_rate_hz)))
    people.print_table(("lean", "nearest", "farthest", "outside", "foot", "first", "last", "last/first"), rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("leader", help="a motion file with the joints of the model")
    parser.add_argument("--minutes", type=float, default=60, help="of each leader (default: %(default)s)")
    parser.add_argument("--delay", type=int, default=0, help="leader frames that the server waits for")
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    parser.add_argument("--model", default="", help="name of the model (default: the server's)")
    asyncio.run(run(parser.parse_args()))


if __name__ == "__main__":
    main()
