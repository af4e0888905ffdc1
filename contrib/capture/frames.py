"""What all readers have in common: frames, their joints, and rotations.

Positions are in metres, y up, right-handed. Rotations are unit quaternions x, y, z, w.
"""

import math
import re
from typing import List, NamedTuple, Optional

import numpy as np

# No capture volume is larger; positions beyond it are errors of the sender.
MAX_POSITION = 1000.0
# Differences of such times, in seconds, are exact to a millisecond.
MAX_SECONDS = 1e12
MIRROR = np.array([-1.0, 1.0, 1.0])  # between Unity's left-handed axes and right-handed ones

# Bone, parent, and offset from the parent of a person of 1.6 m in a T pose that faces +z. The names are
# those of Unity's humanoid.
BONES = (
    ("Hips", "", (0, 0.95, 0)), ("Spine", "Hips", (0, 0.10, 0)), ("Chest", "Spine", (0, 0.13, 0)),
    ("UpperChest", "Chest", (0, 0.12, 0)), ("Neck", "UpperChest", (0, 0.15, 0)),
    ("Head", "Neck", (0, 0.09, 0)),
    ("LeftShoulder", "UpperChest", (0.04, 0.11, 0)), ("LeftUpperArm", "LeftShoulder", (0.13, 0, 0)),
    ("LeftLowerArm", "LeftUpperArm", (0.28, 0, 0)), ("LeftHand", "LeftLowerArm", (0.25, 0, 0)),
    ("RightShoulder", "UpperChest", (-0.04, 0.11, 0)), ("RightUpperArm", "RightShoulder", (-0.13, 0, 0)),
    ("RightLowerArm", "RightUpperArm", (-0.28, 0, 0)), ("RightHand", "RightLowerArm", (-0.25, 0, 0)),
    ("LeftUpperLeg", "Hips", (0.09, -0.05, 0)), ("LeftLowerLeg", "LeftUpperLeg", (0, -0.42, 0)),
    ("LeftFoot", "LeftLowerLeg", (0, -0.41, 0)), ("LeftToes", "LeftFoot", (0, -0.05, 0.13)),
    ("RightUpperLeg", "Hips", (-0.09, -0.05, 0)), ("RightLowerLeg", "RightUpperLeg", (0, -0.42, 0)),
    ("RightFoot", "RightLowerLeg", (0, -0.41, 0)), ("RightToes", "RightFoot", (0, -0.05, 0.13)))
BONE_NAMES = tuple(name for name, _, _ in BONES)
PARENTS = tuple(BONE_NAMES.index(parent) if parent else -1 for _, parent, _ in BONES)
OFFSETS = np.array([offset for _, _, offset in BONES], dtype=float)

# What files and senders call the bones, besides Unity's names in any case.
_ALIASES = {"pelvis": "Hips", "skull": "Head", "arm": "UpperArm", "elbow": "LowerArm",
            "forearm": "LowerArm", "wrist": "Hand", "upleg": "UpperLeg", "thigh": "UpperLeg",
            "hip": "UpperLeg", "knee": "LowerLeg", "shin": "LowerLeg", "calf": "LowerLeg",
            "leg": "LowerLeg", "ankle": "Foot", "toe": "Toes", "toebase": "Toes", "ball": "Toes"}


class Frame(NamedTuple):
    """One frame of a capture."""

    seconds: Optional[float]
    """When the sender captured it, on the sender's clock. None if the sender does not say, or repeats the
    time of another frame."""
    positions: np.ndarray
    """``[joints, 3]``, in the joints of the reader."""


class Reader:
    """Reads the datagrams of one capture protocol, and keeps the part of a frame that has not arrived
    completely. Subclasses take arbitrary bytes."""

    joint_names: List[str] = []

    def __init__(self) -> None:
        self.notes: List[str] = []  # for the user; taken by the stream

    def read(self, datagram: bytes) -> List[Frame]:
        """The frames that the datagram completes.

        Raises:
            ValueError: it is malformed, or of another protocol. Later datagrams can be read as if it had
                not arrived.
        """
        raise NotImplementedError

    def missing(self) -> str:
        """What would make a frame, and what has arrived, if no frame has."""
        return ""


def find_bone(name: str) -> int:
    """The index of a bone by its name in Unity, VRM 1.0 (``leftUpperArm``) or a file (``LeftArm``,
    ``l_wrist``, ``ankle.R``); -1 if it is none."""
    words = re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name.split(":")[-1])
    sides = {"left": "Left", "l": "Left", "right": "Right", "r": "Right"}
    side = next((sides[word.lower()] for word in words if word.lower() in sides), "")
    base = "".join(word.lower() for word in words if word.lower() not in sides)
    if not side and base == "hip":
        base = "hips"
    for candidate in (base, _ALIASES.get(base, "").lower()):
        for index, bone in enumerate(BONE_NAMES):
            if candidate and bone.lower() == side.lower() + candidate:
                return index
    return -1


def checked(value: float, limit: float) -> Optional[float]:
    """The number, or None if it is not finite or beyond the limit."""
    return float(value) if math.isfinite(value) and abs(value) <= limit else None


def multiply(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """First q, then p."""
    return np.append(p[3] * q[:3] + q[3] * p[:3] + np.cross(p[:3], q[:3]), p[3] * q[3] - p[:3] @ q[:3])


def rotate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    return v + 2 * np.cross(q[:3], np.cross(q[:3], v) + q[3] * v)


def inverse(q: np.ndarray) -> np.ndarray:
    return q * (-1, -1, -1, 1)


def unit(v: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """The vector with length 1; `otherwise` if it has none."""
    length = float(np.linalg.norm(v))
    return v / length if length > 1e-9 else np.asarray(otherwise, dtype=float)


IDENTITY = np.array([0.0, 0.0, 0.0, 1.0])
