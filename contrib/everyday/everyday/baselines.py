"""Reads a data set of pairs, and answers leaders from its training pairs."""

import dataclasses
import json

import numpy

WINDOW_SECONDS, STEP_FRAMES = 2.0, 5


@dataclasses.dataclass(frozen=True)
class Data:
    joint_names: tuple
    parents: tuple
    rate: float
    pairs: list


@dataclasses.dataclass(frozen=True)
class LabelledPair:
    """`leader`, `follower`: [frames, joints, 3]. `mirror`: where each joint's other side is."""
    name: str
    label: str
    leader: numpy.ndarray
    follower: numpy.ndarray
    is_left_out: bool
    is_symmetric: bool
    hips: tuple
    mirror: tuple

    def roles(self):
        """The pair, and with the roles exchanged if either person may lead."""
        exchanged = dataclasses.replace(self, name=self.name + "_b", leader=self.follower,
                                        follower=self.leader)
        return [self, exchanged] if self.is_symmetric else [self]


def _other_side(name):
    return (name.replace("left", "right") if "left" in name else name.replace("right", "left"))


def read(folder):
    """Every sequence, with the first class of its time line; copies are left out."""
    document = json.loads((folder / "dataset.json").read_text(encoding="utf-8"))
    skeleton = document["skeleton"]
    names = tuple(skeleton["joint_names"])
    parent = {child: names.index(above) for above, child in skeleton["bones"]}
    symmetric = frozenset(one["name"] for one in document["classes"] if one.get("symmetric"))
    hips = names.index(skeleton["left_hip"]), names.index(skeleton["right_hip"])
    mirror = tuple(names.index(_other_side(name)) for name in names)
    labels = {}
    for row in (folder / "labels.tsv").read_text(encoding="utf-8").splitlines()[1:]:
        labels.setdefault(row.split("\t")[0], row.split("\t")[1])
    rows = [row.split("\t") for row in (folder / "index.tsv").read_text(encoding="utf-8").splitlines()]
    pairs = []
    for row in rows[1:]:
        cells = dict(zip(rows[0], row))
        if "_copy" in cells["path"]:
            continue
        values = numpy.loadtxt(folder / cells["path"], delimiter=",")[:, 1:]
        people = values.reshape(len(values), 2, len(names), 3).swapaxes(0, 1)
        first = 0 if cells["leader_side"] == "left" else 1
        label = labels[cells["path"]]
        pairs.append(LabelledPair(cells["path"].split("/")[-1].removesuffix(".txt"), label,
                                  people[first], people[1 - first],
                                  "left_out" in cells["subjects"].split(","), label in symmetric,
                                  hips, mirror))
    return Data(names, tuple(parent.get(name, -1) for name in names), document["frame_rate_hz"],
                pairs)


def _anchor(pose, hips):
    """(origin, axes) of a person: its root on the floor, and its right, up and back."""
    across = (pose[hips[1]] - pose[hips[0]]) * [1, 0, 1]
    across = across / numpy.linalg.norm(across)
    up = numpy.array([0.0, 1.0, 0.0])
    return pose[0] * [1, 0, 1], numpy.stack([across, up, numpy.cross(across, up)])


def _local(points, anchor):
    return (points - anchor[0]) @ anchor[1].T


def _world(points, anchor):
    return points @ anchor[1] + anchor[0]


def _stretched(motion, frames):
    at = numpy.linspace(0, len(motion) - 1, frames)
    before = numpy.minimum(at.astype(int), len(motion) - 2)
    share = (at - before)[:, None, None]
    return (1 - share) * motion[before] + share * motion[before + 1]


def _candidates(pairs):
    """(leader, follower) of the pairs: as captured, mirrored, and exchanged where symmetric."""
    for pair in (both for one in pairs for both in one.roles()):
        yield pair.leader, pair.follower
        yield tuple(one[:, pair.mirror] * [-1, 1, 1] for one in (pair.leader, pair.follower))


def _nearest_window(leader, hips, candidates, known):
    """`known`: the follower's first joints in the first frame, [joints, 3], or None."""
    frames, best = len(leader), (numpy.inf, None)
    anchor = _anchor(leader[0], hips)
    wanted = _local(leader, anchor)
    for led, followed in candidates:
        if len(led) < frames:
            led, followed = _stretched(led, frames), _stretched(followed, frames)
        for first in range(0, len(led) - frames + 1, STEP_FRAMES):
            own = _anchor(led[first], hips)
            cost = numpy.linalg.norm(_local(led[first:first + frames], own) - wanted, axis=-1).mean()
            if known is not None:
                away = _local(followed[first, :len(known)], own) - _local(known, anchor)
                cost += numpy.linalg.norm(away, axis=-1).mean()
            if cost < best[0]:
                best = cost, _local(followed[first:first + frames], own)
    answer = _world(best[1], anchor)
    return answer if known is None else answer + (known[0] - answer[0, 0]) * [1, 0, 1]


def nearest(pair, train, rate, start=None):
    """The training follower whose leader moves most alike, chosen anew every WINDOW_SECONDS.

    With `start`, the root or the pose of the captured follower's first frame ([1 or joints, 3]), it
    also counts where the follower begins, and it begins there, or where the window before ended.
    """
    candidates = list(_candidates([one for one in train if one.label == pair.label]))
    count = max(1, round(len(pair.leader) / (WINDOW_SECONDS * rate)))
    known, parts = start, []
    for part in numpy.array_split(pair.leader, count):
        parts.append(_nearest_window(part, pair.hips, candidates, known))
        known = None if start is None else 2 * parts[-1][-1] - parts[-1][-2]
    return numpy.concatenate(parts)


def class_mean(pair, train):
    """In each frame the mean training follower of the class, as it stands to its leader."""
    poses = [_local(follower[t], _anchor(leader[t], pair.hips))
             for leader, follower in _candidates([one for one in train if one.label == pair.label])
             for t in range(0, len(leader), STEP_FRAMES)]
    mean = numpy.mean(poses, axis=0)
    return numpy.stack([_world(mean, _anchor(pose, pair.hips)) for pose in pair.leader])
