"""A body over time, and its key frames for duet-keyframe (docs/formats.md).

Axes: x to the left of a body of yaw 0, y up, z forwards; metres, degrees, seconds.
"""

import dataclasses
import math

KEYS_PER_SECOND = 10
STANDING_TORSO, WALKING_TORSO = 1.1, 1.06
_ANKLE = 0.08
_HALF_STANCE = 0.11
_SWING_SECONDS = 0.45
_LIFT = 0.12
_FARTHEST_FOOT = 0.1  # from below the body, before a step is taken
_METRES_PER_DEGREE = 0.005  # how a turn of the body counts as a distance of the foot


@dataclasses.dataclass
class Body:
    """One key: what a formula decides. The feet follow from the place."""

    x: float = 0
    z: float = 0
    yaw: float = 0
    torso: float = STANDING_TORSO
    back: float = 0  # of the hips, behind the feet
    sway: float = 0  # of the hips, to the left
    pitch: float = 0
    roll: float = 0
    chest_yaw: float = 0  # against the hips
    head_yaw: float = 0
    head_pitch: float = 0
    left_hand: tuple = (0.21, -0.55, 0.05)  # from the neck, as the chest faces
    right_hand: tuple = (-0.21, -0.55, 0.05)


def turned(x, z, yaw):
    """A horizontal vector of a body of yaw 0, turned with the body."""
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    return c * x + s * z, c * z - s * x


def _home(body, side):
    dx, dz = turned(side * _HALF_STANCE, 0, body.yaw)
    return body.x + dx, body.z + dz, body.yaw


def _distance(foot, home):
    turn = abs((foot[2] - home[2] + 180) % 360 - 180)
    return math.hypot(foot[0] - home[0], foot[1] - home[1]) + _METRES_PER_DEGREE * turn


def place_feet(bodies):
    """The left and the right ankle of every key: [(x, y, z), (x, y, z)].

    A foot stands until the body has moved away from it. Then it steps to where the body is going to
    be. One foot steps at a time.
    """
    swing = max(2, round(_SWING_SECONDS * KEYS_PER_SECOND))
    feet = {side: _home(bodies[0], side) for side in (1, -1)}
    swinging = None  # side, first key, from, to
    placed = []
    for t in range(len(bodies)):
        if swinging is None:
            side = max(feet, key=lambda s: _distance(feet[s], _home(bodies[t], s)))
            ahead = bodies[min(t + 3 * swing // 2, len(bodies) - 1)]
            if _distance(feet[side], _home(bodies[t], side)) > _FARTHEST_FOOT:
                swinging = (side, t, feet[side], _home(ahead, side))
        heights = {1: 0, -1: 0}
        if swinging is not None:
            side, first, start, end = swinging
            way = min(1, (t - first) / swing)
            smooth = way * way * (3 - 2 * way)
            feet[side] = tuple(a + (b - a) * smooth for a, b in zip(start, end))
            heights[side] = _LIFT * math.sin(math.pi * way)
            if way == 1:
                swinging = None
        placed.append([(feet[s][0], _ANKLE + heights[s], feet[s][1]) for s in (1, -1)])
    return placed


def key_frames(bodies):
    """The text of a key-frame file."""
    lines = []
    for t, (body, (left, right)) in enumerate(zip(bodies, place_feet(bodies))):
        across, along = turned(body.sway, -body.back, body.yaw)
        chest = body.yaw + body.chest_yaw

        def hand(offset, yaw=chest):
            x, z = turned(offset[0], offset[2], yaw)
            return x, offset[1], z

        tracks = {
            "torso": (body.x + across, body.torso, body.z + along),
            "pelvis": (body.yaw, 0.4 * body.pitch, body.roll),
            "chest": (chest, body.pitch, -0.5 * body.roll),
            "head": (chest + body.head_yaw, body.head_pitch, 0),
            "left_foot": left,
            "right_foot": right,
            "left_hand": hand(body.left_hand),
            "right_hand": hand(body.right_hand),
        }
        lines.append(f"at {t / KEYS_PER_SECOND:.2f}")
        lines += [f"  {name} " + " ".join(f"{v:.4f}" for v in values)
                  for name, values in tracks.items()]
    return "\n".join(lines) + "\n"
