#!/usr/bin/env python3
"""Measures served models on whole takes of a dance, beside the captured follower (README.md).

    contrib/studies/dance.py --data salsa --take take_05
    contrib/studies/dance.py --data salsa --take take_03 take_05 take_11 --model salsa@1 salsa@2
"""

import argparse
import csv
from pathlib import Path

import numpy as np
import people

import duet_motion as duet


def read_take(folder, name):
    """The people of a take, leader first, and its classes as key frames.

    Args:
        folder: of the data set (docs/datasets.md).
        name: part of the take's path, such as its subject.

    Raises:
        ValueError: not one take has this name, or the data are not in metres with y up.
    """
    described, index = people.read_data(folder)
    entries = [row for row in index if name in (row["path"], *row.get("subjects", "").split(","))]
    if len(entries) != 1:
        raise ValueError(f"--take: expected the path or the subject of one take, got {name}")
    entry = entries[0]
    names, rate = described["skeleton"]["joint_names"], described["frame_rate_hz"]
    pair = people.read_pair(folder, described, entry)
    with open(folder / "labels.tsv", encoding="utf-8") as file:
        spans = [(row["class"], *(round(float(row[key]) * rate) for key in ("from_seconds", "to_seconds")))
                 for row in csv.DictReader(file, delimiter="\t") if row["path"] == entry["path"]]
    return *(duet.Motion(person, names, rate) for person in pair), keyframes(spans, len(pair[0]))


def keyframes(spans, frames):
    """Weights of 1 within each span (class, first frame, end), changing from one frame to the next."""
    def weights(frame):
        return {name: float(begin <= frame < end) for name, begin, end in spans}
    edges = {edge for _, *both in spans for edge in both if 0 < edge < frames}
    return {frame: weights(frame) for frame in sorted({0} | edges | {edge - 1 for edge in edges})}


def measure(leader, captured, follower):
    """A row of the table. Shapes: positions [frames, joints, 3] of duet.Motion."""
    names, rate = leader.joint_names, leader.frame_rate_hz
    a, b, c = (motion.positions for motion in (leader, follower, captured))
    made = people.turns(a, b, names, rate)
    return (float(np.linalg.norm(b - c, axis=-1).mean()), float(people.root_distance(a, b, names).mean()),
            people.hands_held(a, b, names), len(made),
            people.matched_turns(people.turns(a, c, names, rate), made), people.joint_speed(b, rate))


def moved_by_half(follower):
    """The same motion, its second half first: it belongs to another part of the leader."""
    return follower.with_positions(np.roll(follower.positions, follower.frame_count // 2, axis=0))


def answers_of(client, model, take, seeds):
    """The followers of a take, one for each seed."""
    leader, captured, labels = take
    return [client.synthesize(leader, keyframes=labels, seed=seed, model=model,
                              follower_start=captured.positions[0]).follower for seed in range(seeds)]


def rows_of(client, models, take, seeds):
    """{name of a row: figures} of one take."""
    leader, captured, _ = take
    held = captured.with_positions(np.repeat(captured.positions[:1], captured.frame_count, axis=0))
    rows = {"captured": measure(leader, captured, captured), "first pose held": measure(leader, captured, held)}
    for model in models:
        answers = answers_of(client, model, take, seeds)
        name = model or "answer"
        for suffix, shown in (("", answers), (", moved by half", map(moved_by_half, answers))):
            rows[name + suffix] = np.mean([measure(leader, captured, answer) for answer in shown], axis=0)
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of the data set")
    parser.add_argument("--take", nargs="+", required=True,
                        help="paths or subjects of takes that the models have not seen; the figures are means over them")
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    parser.add_argument("--model", nargs="+", default=[""],
                        help="names of models, each NAME or NAME@VERSION (default: the server's)")
    parser.add_argument("--seeds", type=int, default=3, help="answers (default: %(default)s)")
    options = parser.parse_args()
    with duet.Client(options.server) as client:
        tables = [rows_of(client, options.model, read_take(options.data, take), options.seeds)
                  for take in options.take]
    people.print_table(("error", "distance", "hands", "turns", "matched", "speed"),
                       [(name, np.nanmean([table[name] for table in tables], axis=0)) for name in tables[0]])


if __name__ == "__main__":
    main()
