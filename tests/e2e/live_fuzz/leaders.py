"""Poses of a plan (plans.py) in the coordinates of its caller: of the leader, and of a follower that the caller
makes up."""

import random

import live_clients

# From metres, y up.
AXES = {"y_up": lambda x, y, z: (x, y, z),
        "z_up": lambda x, y, z: (x, -z, y),
        "y_down": lambda x, y, z: (x, -y, -z)}
MILLIMETRES = 1000


def to_caller(unit, axis, point):
    x, y, z = point
    if unit == "sbu_normalised":
        return ((1.28 - x) / 2.56, (0.96 - y) / 1.92, z / 1.28)
    scale = MILLIMETRES if unit == "millimetres" else 1
    return tuple(scale * value for value in AXES[axis](x, y, z))


class Poses:
    """The frames of a person by their index, [joints x 3] each. `kind`: how the person moves."""

    def __init__(self, plan, joints, kind, ahead=0.0):
        self._plan = plan
        self._joints = joints
        self._kind = kind
        self._ahead = ahead  # metres

    def frames(self, first, count):
        return [self.frame(index) for index in range(first, first + count)]

    def frame(self, index):
        plan, kind = self._plan, self._kind
        shown = 0 if kind == "still" else index
        [pose] = live_clients.person(self._joints, plan["rate"], 1, shown)
        chance = random.Random(f"{plan['leader_seed']}/{kind}/{index}")
        jump = 3.0 * (index // 20 % 2) if kind == "jumps" else 0.0
        shake = {"noise": 1.0, "shaking": 0.05}.get(kind, 0.0)
        values = []
        for x, y, z in zip(pose[0::3], pose[1::3], pose[2::3]):
            if kind == "point":
                x, y, z = 0.5, 1.0, 0.5
            point = [value + shake * chance.uniform(-1, 1) for value in (x + jump, y, z + self._ahead)]
            values.extend(to_caller(plan["unit"], plan["axis"], point))
        return values


def leader_of(plan, joints):
    return Poses(plan, joints, plan["leader"])


def follower_of(plan, joints, kind="person"):
    """A follower of which no server sent a frame."""
    return Poses(plan, joints, kind, ahead=1.0)
