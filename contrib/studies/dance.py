#!/usr/bin/env python3
"""Measures a served model on a whole take of a dance, beside the captured follower (README.md).

    contrib/studies/dance.py --data salsa --take take_05
"""

import argparse
import csv
import json
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
    described = json.loads((folder / "dataset.json").read_text(encoding="utf-8"))
    if (described["unit"], described["up_axis"]) != ("metres", "y-up"):
        raise ValueError(f"--data: expected metres and y-up, got {described['unit']}, {described['up_axis']}")
    with open(folder / "index.tsv", encoding="utf-8") as file:
        entries = [row for row in csv.DictReader(file, delimiter="\t")
                   if name in (row["path"], *row.get("subjects", "").split(","))]
    if len(entries) != 1:
        raise ValueError(f"--take: expected the path or the subject of one take, got {name}")
    entry = entries[0]
    names, rate = described["skeleton"]["joint_names"], described["frame_rate_hz"]
    rows = np.genfromtxt(folder / entry["path"], delimiter=",")[:, 1:1 + 6 * len(names)]
    pair = rows.reshape(len(rows), 2, len(names), 3)
    if entry["leader_side"] == "right":
        pair = pair[:, ::-1]
    with open(folder / "labels.tsv", encoding="utf-8") as file:
        spans = [(row["class"], *(round(float(row[key]) * rate) for key in ("from_seconds", "to_seconds")))
                 for row in csv.DictReader(file, delimiter="\t") if row["path"] == entry["path"]]
    return *(duet.Motion(pair[:, i], names, rate) for i in range(2)), keyframes(spans, len(rows))


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


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of the data set")
    parser.add_argument("--take", required=True, help="path or subject of a take that the model has not seen")
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    parser.add_argument("--model", default="", help="name of the model (default: the server's)")
    parser.add_argument("--seeds", type=int, default=3, help="answers (default: %(default)s)")
    options = parser.parse_args()
    leader, captured, labels = read_take(options.data, options.take)
    held = captured.with_positions(np.repeat(captured.positions[:1], captured.frame_count, axis=0))
    answers = []
    with duet.Client(options.server) as client:
        for seed in range(options.seeds):
            answers.append(client.synthesize(leader, keyframes=labels, seed=seed, model=options.model,
                                             follower_start=captured.positions[0]).follower)
    people.print_table(
        ("error", "distance", "hands", "turns", "matched", "speed"),
        [("captured", measure(leader, captured, captured)),
         ("first pose held", measure(leader, captured, held)),
         ("answer", np.mean([measure(leader, captured, answer) for answer in answers], axis=0)),
         ("answer, moved by half",
          np.mean([measure(leader, captured, moved_by_half(answer)) for answer in answers], axis=0))])


if __name__ == "__main__":
    main()
