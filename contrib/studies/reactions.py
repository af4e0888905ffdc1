#!/usr/bin/env python3
"""Measures how followers react to strikes, and how far an avoided class moves them (README.md).

    contrib/studies/reactions.py --data sbu_solved --subjects s03 --leaders 3 --model sbu@3
"""

import argparse
import functools
from pathlib import Path
from typing import NamedTuple

import numpy as np
import people

import duet_motion as duet

NOISE_SECONDS = 0.1  # deviation of the Gaussian that takes the noise out of captures
BEFORE_SECONDS, AFTER_SECONDS = 0.3, 1  # the time about the leader's action in which a follower goes back
PADDING_SECONDS = 1
RESAMPLES = 400
FIGURES = ("amplitude, head", "amplitude, torso", "goes back, head", "goes back, torso", "correlation")
CONSTANT = 1e-9  # a series with a smaller deviation has no correlation with another


class Body(NamedTuple):
    """Indices of joints."""
    root: int
    head: int
    ends: list  # hands and feet


class Capture(NamedTuple):
    """A clip of a leader and of the follower who was captured with it."""
    index: int  # in the data set; also the seed, so that no two leaders share one
    label: str  # the class
    leader: np.ndarray
    follower: np.ndarray


def body_of(skeleton):
    names = skeleton["joint_names"]
    root, *feet = (names.index(skeleton[key]) for key in ("root", "left_foot", "right_foot"))
    return Body(root, people.joints(names, "head")[0], people.joints(names, "_wrist", "_hand") + feet)


def read_captures(folder, subjects, most):
    """The data set's description, and `most` captures (0: all) of each class with these people, evenly spread."""
    described, index = people.read_data(folder)
    index.sort(key=lambda row: row["path"])
    captures = []
    for label in (one["name"] for one in described["classes"]):
        found = [i for i, row in enumerate(index) if row["path"].split("/")[0] == label
                 and not subjects.isdisjoint(row.get("subjects", "").split(","))]
        count = min(most or len(found), len(found))
        captures += [Capture(i, label, *people.read_pair(folder, described, index[i]))
                     for i in (found[n * len(found) // count] for n in range(count))]
    if not captures:
        raise ValueError(f"--subjects: expected people in captures of its classes, got {', '.join(sorted(subjects))}")
    return described, captures


def without_noise(positions, rate):
    """Smoothed over time; continued beyond each end by its reflection about the end point."""
    sigma = NOISE_SECONDS * rate
    radius = int(np.ceil(3 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-radius, radius + 1) / sigma) ** 2)
    padded = np.pad(positions, ((radius, radius), (0, 0), (0, 0)), mode="reflect", reflect_type="odd")
    return sum(weight * padded[i:i + len(positions)] for i, weight in enumerate(kernel / kernel.sum()))


def correlation(a, b):
    """Pearson's; 0 if either side is constant."""
    a, b = a - a.mean(), b - b.mean()
    scale = np.sqrt((a @ a) * (b @ b))
    return a @ b / scale if scale > CONSTANT else 0.0


def reaction(capture, follower, rate, body):
    """How far head and torso go back about the leader's action, and when: (metres, metres, correlation)."""
    away = (capture.follower - capture.leader)[0, body.root] * [1, 0, 1]
    away = away / np.linalg.norm(away) if away.any() else np.array([1, 0, 0])
    leader, captured, made = (without_noise(positions, rate) @ away
                              for positions in (capture.leader, capture.follower, follower))
    action = int((leader[:, body.ends] - leader[:, [body.root]]).max(axis=1).argmax())
    first, end = max(0, action - int(BEFORE_SECONDS * rate)), action + int(AFTER_SECONDS * rate) + 1
    pair = [body.head, body.root]
    head, torso = made[first:end, pair].max(axis=0) - made[first, pair]
    velocity, other = (np.diff(positions[:, pair].mean(axis=1), prepend=positions[0, pair].mean())
                       for positions in (captured, made))
    return head, torso, correlation(velocity, other)


def estimate(leaders, statistic):
    """The statistic of all rows, and its 95 % interval by the bootstrap over leaders, each with all its rows."""
    random = np.random.default_rng(0)
    groups = [np.flatnonzero(leaders == leader) for leader in np.unique(leaders)]
    values = [statistic(np.concatenate([groups[i] for i in random.integers(len(groups), size=len(groups))]))
              for _ in range(RESAMPLES)]
    return np.array([statistic(np.arange(len(leaders))), *np.nanquantile(values, (0.025, 0.975), axis=0)])


def figures(made, captured, usual):
    """FIGURES of answers. Shapes: made and captured [rows, 3], of reaction(); usual [rows, 2], means of the class."""
    amplitude = made[:, :2].mean(axis=0) / captured[:, :2].mean(axis=0)
    return np.array([*amplitude, *(made[:, :2] > usual / 2).mean(axis=0), made[:, 2].mean()])


def reaction_rows(captures, captured, *answers):
    """(name, estimates of each kind of answer). Shapes: captured and each kind [captures, 3], of reaction()."""
    leaders, labels = (np.array([getattr(one, field) for one in captures]) for field in ("index", "label"))
    usual = np.array([captured[labels == label, :2].mean(axis=0) for label in labels])
    estimates = [estimate(leaders, lambda rows, made=made: figures(made[rows], captured[rows], usual[rows]))
                 for made in answers]
    return list(zip(FIGURES, np.concatenate(estimates).T))


def answer(client, model, described, told, capture, leader, weights):
    """The follower's positions."""
    direction, root = None, body_of(described["skeleton"]).root
    if "people_axis" in described:
        axis = np.eye(3)["xyz".index(described["people_axis"])]
        direction = axis if (capture.follower - capture.leader)[0, root] @ axis >= 0 else -axis
    motion = duet.Motion(leader, described["skeleton"]["joint_names"], described["frame_rate_hz"])
    return client.synthesize(motion, labels=weights, seed=capture.index, model=model, partner_direction=direction,
                             follower_start=capture.follower[0] if told else None).follower.positions


def distances_moved(ask, described, captures):
    """(leaders, metres): by how much each other class at -1 moves the roots' mean distance along the floor."""
    root, rows = body_of(described["skeleton"]).root, []

    def distance(capture, avoided):
        apart = ask(capture, capture.leader, {capture.label: 1, **avoided}) - capture.leader
        return np.linalg.norm(apart[:, root, ::2], axis=1).mean()

    for capture in captures:
        alone = distance(capture, {})
        rows += [(capture.index, abs(distance(capture, {one["name"]: -1}) - alone))
                 for one in described["classes"] if one["name"] != capture.label]
    return np.array(rows).T


def reactions(ask, described, captures):
    """Of the captured follower, the answer and the answer to a padded leader. Shapes: returns [3, captures, 3]."""
    rate, body = described["frame_rate_hz"], body_of(described["skeleton"])
    padding, rows = round(PADDING_SECONDS * rate), []
    for capture in captures:
        padded = np.pad(capture.leader, ((padding, padding), (0, 0), (0, 0)), mode="edge")
        made, late = (ask(capture, leader, {capture.label: 1}) for leader in (capture.leader, padded))
        rows.append([reaction(capture, follower, rate, body)
                     for follower in (capture.follower, made, late[padding:padding + len(made)])])
    return np.moveaxis(np.array(rows), 1, 0)


def tables(ask, described, captures, classes):
    """(columns, rows) of each table. `ask` answers (capture, leader, weights)."""
    leaders, metres = distances_moved(ask, described, captures)
    striking = [capture for capture in captures if capture.label in classes]
    return [(("own 1, other -1",), [("distance moved", estimate(leaders, lambda rows: metres[rows].mean()))]),
            (("as captured", "padded"), reaction_rows(striking, *reactions(ask, described, striking)))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of the data set")
    parser.add_argument("--subjects", required=True, help="people that the model has not seen, such as s03,s05")
    parser.add_argument("--leaders", type=int, default=0, help="of each class; 0: all (default: %(default)s)")
    parser.add_argument("--classes", default="kick,push,punch", help="of the reactions (default: %(default)s)")
    parser.add_argument("--server", help="host:port (default: DUET_SERVER, or localhost:50051)")
    parser.add_argument("--model", default="", help="name of the model (default: the server's)")
    options = parser.parse_args()
    described, captures = read_captures(options.data, set(options.subjects.split(",")), options.leaders)
    classes = options.classes.split(",")
    if not any(capture.label in classes for capture in captures):
        parser.error(f"--classes: expected classes with captures of --subjects, got {options.classes}")
    with duet.Client(options.server) as client:
        for told in (False, True):
            ask = functools.partial(answer, client, options.model, described, told)
            for columns, rows in tables(ask, described, captures, classes):
                print("first pose told" if told else "nothing told",
                      *(name for column in columns for name in (column, "low", "high")), sep="\t")
                for name, values in rows:
                    print(name, *(f"{value:.3f}" for value in values), sep="\t")


if __name__ == "__main__":
    main()
