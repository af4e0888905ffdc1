"""Two people of a data set, and figures of them: arrays ``[frames, joints, 3]`` in metres, y up."""

import csv
import json

import numpy as np

TURN_DEGREES, TURN_SPEED, MATCH_SECONDS = 230, 45, 1.5
HOLD_METRES = 0.12


def read_data(folder):
    """A data set's description and the rows of its index (docs/datasets.md).

    Raises:
        ValueError: the data are not in metres with y up.
    """
    described = json.loads((folder / "dataset.json").read_text(encoding="utf-8"))
    if (described["unit"], described["up_axis"]) != ("metres", "y-up"):
        raise ValueError(f"--data: expected metres and y-up, got {described['unit']}, {described['up_axis']}")
    with open(folder / "index.tsv", encoding="utf-8") as file:
        return described, list(csv.DictReader(file, delimiter="\t"))


def read_pair(folder, described, entry):
    """The leader and the follower of a row of the index."""
    if entry["leader_side"] not in ("left", "right"):
        raise ValueError(f"index.tsv: leader_side of {entry['path']}: expected left or right, "
                         f"got {entry['leader_side']}")
    count = len(described["skeleton"]["joint_names"])
    rows = np.genfromtxt(folder / entry["path"], delimiter=",")[:, 1:1 + 6 * count]
    left, right = np.moveaxis(rows.reshape(len(rows), 2, count, 3), 1, 0)
    return (left, right) if entry["leader_side"] == "left" else (right, left)


def joints(names, *endings):
    """Indices of the joints whose names end like the first of `endings` that any joint has."""
    for ending in endings:
        if found := [i for i, name in enumerate(names) if name.endswith(ending)]:
            return found
    raise ValueError(f"joints: expected one that ends in {' or '.join(endings)}, got {', '.join(names)}")


def root(positions, names):
    """The middle of the hips. Shapes: returns [frames, 3]."""
    return positions[:, joints(names, "_hip")].mean(axis=1)


def root_distance(leader, follower, names):
    """Along the floor. Shapes: returns [frames]."""
    apart = root(follower, names) - root(leader, names)
    return np.hypot(apart[:, 0], apart[:, 2])


def joint_speed(positions, rate):
    """The mean of all joints, m/s."""
    return float(np.linalg.norm(np.diff(positions, axis=0), axis=-1).mean() * rate)


def hands_held(leader, follower, names):
    """The share of frames in which a hand of one is near a hand of the other."""
    hands = joints(names, "_hand", "_wrist")
    apart = np.linalg.norm(leader[:, hands, None] - follower[:, None, hands], axis=-1)
    return float((apart.min(axis=(1, 2)) < HOLD_METRES).mean())


def lean_degrees(positions, names):
    """From the middle of the hips to the neck, from the vertical. Shapes: returns [frames]."""
    trunk = positions[:, joints(names, "neck", "head")[0]] - root(positions, names)
    return np.degrees(np.arctan2(np.hypot(trunk[:, 0], trunk[:, 2]), trunk[:, 1]))


def turns(leader, follower, names, rate):
    """The follower's rotations against the line between the two: (middle in seconds, direction)."""
    left, right = (follower[:, joints(names, f"{side}_hip")[0]] for side in ("left", "right"))
    across, line = right - left, root(leader, names) - root(follower, names)
    angle = np.unwrap(np.arctan2(across[:, 2], across[:, 0]) - np.arctan2(line[:, 2], line[:, 0]))
    speed = np.degrees(np.gradient(angle)) * rate
    found = []
    for direction in (1, -1):
        fast = np.flatnonzero(direction * speed > TURN_SPEED)
        pause = int(0.3 * rate) + 1
        for run in np.split(fast, np.flatnonzero(np.diff(fast) > pause) + 1):
            if len(run) and np.degrees(direction * (angle[run[-1]] - angle[run[0]])) >= TURN_DEGREES:
                found.append(((run[0] + run[-1]) / 2 / rate, direction))
    return found


def matched_turns(captured, made):
    """The share of captured turns with one the same way at the time; NaN without captured ones."""
    if not captured:
        return float("nan")
    return sum(any(way == other and abs(time - at) <= MATCH_SECONDS for at, other in made)
               for time, way in captured) / len(captured)


def print_table(columns, rows):
    """`rows`: (name, values)."""
    width = max(len(name) for name, _ in rows)
    print(" " * width, *(f"{column:>10}" for column in columns))
    for name, values in rows:
        print(f"{name:{width}}", *(f"{value:10.3f}" for value in values))
