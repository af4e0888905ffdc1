"""Reads and writes the Virtual Motion Capture protocol (VMC, v3.1 of its specification): bones relative to
their parents, in Unity's left-handed axes, as OSC over UDP.

Source: github.com/sh-akira/VirtualMotionCaptureProtocol.
"""

from typing import Dict, List, Optional, Sequence, Set, Tuple

import numpy as np

import osc
from frames import (BONE_NAMES, BONES, IDENTITY, MAX_POSITION, MAX_SECONDS, MIRROR, OFFSETS, PARENTS, Frame,
                    Reader, checked, find_bone, inverse, multiply, rotate, unit)

_BONE, _ROOT, _TIME = "/VMC/Ext/Bone/Pos", "/VMC/Ext/Root/Pos", "/VMC/Ext/T"
_REST = OFFSETS * MIRROR  # of the built-in person, in Unity's axes
_LENGTHS = np.linalg.norm(OFFSETS, axis=1)
_NO_OFFSET = 1e-6  # metres
_NOTES_AFTER_FRAMES = 30
_MOST_REMEMBERED = 6
_MOST_FRAMES_IN_A_DATAGRAM = 8

Transform = Tuple[np.ndarray, np.ndarray]  # position and rotation


class VmcReader(Reader):
    """The joints are the 22 bones of the body.

    A frame may span datagrams. It ends when every bone of the frames before has arrived, at the next time,
    or at a repeated bone. A bone that a frame leaves out keeps its last transform. The children of a bone
    that never came are chained to its nearest ancestor, and the bone itself stands between the two; without
    children it is in its rest pose. Bones at position zero, as senders of rotations have them, get the
    offsets of the built-in person. Fingers, face, cameras and devices are ignored.
    """

    joint_names = list(BONE_NAMES)

    def __init__(self) -> None:
        super().__init__()
        self._root: Transform = (np.zeros(3), IDENTITY)
        self._bones: Dict[int, Transform] = {}
        self._arrived: Set[int] = set()   # in the open frame
        self._previous: Set[int] = set()  # in the last frame
        self._expected: Set[int] = set()  # in the last two frames
        self._seconds: Optional[float] = None
        self._frame_count = 0
        self._other_bones: Set[str] = set()
        self._other_addresses: Set[str] = set()

    def read(self, datagram: bytes) -> List[Frame]:
        frames: List[Frame] = []
        for address, types, data in osc.messages(datagram):
            if len(frames) >= _MOST_FRAMES_IN_A_DATAGRAM:  # only a datagram of repeated bones has more
                return frames
            self._read_message(address, types, data, frames)
        if self._arrived and self._expected and self._expected <= self._arrived:
            self._close(frames)
        return frames

    def missing(self) -> str:
        others = self._other_bones or self._other_addresses
        got = "only the bones " if self._other_bones else "only " if others else "none of them"
        return (f"VMC: expected {_BONE} with Unity's bones ({', '.join(BONE_NAMES)}), got {got}"
                + ", ".join(map(repr, sorted(others))))

    def _read_message(self, address: str, types: str, data: bytes, frames: List[Frame]) -> None:
        if address == _ROOT:
            self._root = _transform(address, types, data)[1:]
        elif address == _BONE:
            name, position, rotation = _transform(address, types, data)
            bone = find_bone(name)
            if bone < 0:
                _remember(name, self._other_bones)
                return
            if bone in self._arrived:
                self._close(frames)
            self._arrived.add(bone)
            self._bones[bone] = (position, rotation)
        elif address == _TIME:
            values = osc.arguments(types, data)
            if not values or isinstance(values[0], str) or checked(values[0], MAX_SECONDS) is None:
                raise ValueError(f"{_TIME}: expected a time in seconds, got the types {types!r}")
            if self._arrived:
                self._close(frames)
            self._seconds = float(values[0])
        else:
            _remember(address, self._other_addresses)

    def _close(self, frames: List[Frame]) -> None:
        self._expected = self._previous | self._arrived
        self._previous, self._arrived = self._arrived, set()
        frames.append(Frame(self._seconds, self._positions()))
        self._seconds = None
        self._frame_count += 1
        if self._frame_count == _NOTES_AFTER_FRAMES:
            self._make_notes()

    def _positions(self) -> np.ndarray:
        """Forward kinematics in Unity's axes: the formulas are the same in both."""
        at = np.zeros((len(BONES), 3))
        turned = np.tile(IDENTITY, (len(BONES), 1))
        skipped = np.zeros((len(BONES), 3))  # offsets of missing bones, of the built-in person
        for bone, parent in enumerate(PARENTS):
            above, turn = self._root if parent < 0 else (at[parent], turned[parent])
            built_in = _REST[bone] + (0 if parent < 0 else skipped[parent])
            if bone not in self._bones:
                # Where its nearest ancestor is, so that its children are chained to that one.
                at[bone], turned[bone], skipped[bone] = above, turn, built_in
                continue
            offset, rotation = self._bones[bone]
            bare = np.linalg.norm(offset) < _NO_OFFSET
            at[bone] = above + rotate(turn, built_in if bare else offset)
            turned[bone] = multiply(turn, rotation)
        for bone in self._never_came():
            at[bone] += rotate(turned[bone], skipped[bone])
        self._place_between(at)
        return at * MIRROR

    def _place_between(self, at: np.ndarray) -> None:
        """Places each missing bone that has a child between its parent and that child, in the proportions of
        the built-in person."""
        for bone in self._never_came():
            if PARENTS[bone] < 0:
                continue
            descendant, below = bone, 0.0
            for child in range(bone + 1, len(BONES)):
                if PARENTS[child] == descendant:
                    descendant, below = child, below + _LENGTHS[child]
                    if child in self._bones:
                        break
            if descendant in self._bones:
                parent = at[PARENTS[bone]]
                share = _LENGTHS[bone] / (_LENGTHS[bone] + below)
                at[bone] = parent + (at[descendant] - parent) * share

    def _never_came(self) -> List[int]:
        return [bone for bone in range(len(BONES)) if bone not in self._bones]

    def _make_notes(self) -> None:
        missing = [BONE_NAMES[bone] for bone in self._never_came()]
        if missing:
            self.notes.append(f"VMC: the sender leaves out {', '.join(missing)}; the bones beyond are chained "
                              "to their nearest ancestor")
        bare = sum(np.linalg.norm(offset) < _NO_OFFSET for offset, _ in self._bones.values())
        if bare > 1:
            self.notes.append(f"VMC: {bare} bones have no position; a built-in person of 1.6 m supplies "
                              "their lengths")


def _transform(address: str, types: str, data: bytes) -> Tuple[str, np.ndarray, np.ndarray]:
    values = osc.arguments(types, data)
    if len(values) < 8 or not isinstance(values[0], str) or any(isinstance(v, str) for v in values[1:8]):
        raise ValueError(f"{address}: expected a name, a position and a quaternion, got the types {types!r}")
    numbers = [checked(value, MAX_POSITION) for value in values[1:8]]
    if None in numbers:
        raise ValueError(f"{address}: expected a position within {MAX_POSITION:g} m and a quaternion, got "
                         f"{values[1:8]} for {values[0]!r}")
    return values[0], np.array(numbers[:3]), unit(np.array(numbers[3:]), IDENTITY)


def _remember(name: str, names: Set[str]) -> None:
    """Keeps a few different names, for a message."""
    if len(names) < _MOST_REMEMBERED:
        names.add(name[:40])


class VmcWriter:
    """Writes a motion with joint rotations (docs/rotations.md) as bones.

    Seventeen bones are sent, with rotations relative to the T pose, as for avatars of VRM, and with the
    follower's own bone lengths as positions. Shoulder blades, upper chest, toes and fingers are not sent:
    a model's joints do not define them.
    """

    MOST_BYTES = 1400  # of a datagram, which is then not fragmented on usual networks
    _PARENTS = {"Hips": "", "Spine": "Hips", "Chest": "Spine", "Neck": "Chest", "Head": "Neck"}
    _LIMBS = (("UpperArm", "Chest", ("shoulder",)), ("LowerArm", "UpperArm", ("elbow",)),
              ("Hand", "LowerArm", ("wrist", "hand")), ("UpperLeg", "Hips", ("hip",)),
              ("LowerLeg", "UpperLeg", ("knee",)), ("Foot", "LowerLeg", ("ankle", "foot")))

    def __init__(self, joint_names: Sequence[str]) -> None:
        """Raises ValueError naming the joints that the motion lacks."""
        self._joints = {name: index for index, name in enumerate(joint_names)}
        self._parents = dict(self._PARENTS)
        self._limbs: Dict[str, str] = {}  # the joint of each bone of a limb
        lacking = [name for name in ("neck", "head") if name not in self._joints]
        for side in ("left", "right"):
            for bone, parent, names in self._LIMBS:
                found = [f"{side}_{name}" for name in names if f"{side}_{name}" in self._joints]
                lacking += [] if found else [f"{side}_{names[-1]}"]
                name = side.capitalize() + bone
                self._limbs[name] = found[0] if found else ""
                in_trunk = parent in self._PARENTS
                self._parents[name] = parent if in_trunk else side.capitalize() + parent
        if lacking:
            raise ValueError(f"follower: expected the joints {', '.join(lacking)}, got "
                             f"{', '.join(joint_names)}")

    def write(self, rig: Sequence, rotations: np.ndarray, positions: np.ndarray,
              seconds: float) -> List[bytes]:
        """The datagrams of one frame.

        Args:
            rig: the joints of ``JointRotations.rig``.
            rotations: ``[rig joints, 4]``, relative to the parents.
            positions: ``[joints, 3]``, metres, y up.
            seconds: of any clock.
        """
        world: List[np.ndarray] = []
        for joint, rotation in zip(rig, np.asarray(rotations, dtype=float)):
            world.append(rotation if joint.parent < 0 else multiply(world[joint.parent], rotation))
        by_name = {joint.name: rotation for joint, rotation in zip(rig, world)}
        bones = self._trunk(by_name, np.asarray(positions, dtype=float))
        for bone, joint in self._limbs.items():
            bones[bone] = (np.asarray(positions[self._joints[joint]], dtype=float), by_name[joint])
        elements = [osc.message("/VMC/Ext/OK", "i", 1), osc.message(_TIME, "f", seconds),
                    _element(_ROOT, "root", np.zeros(3), IDENTITY)]
        for bone, parent in self._parents.items():
            position, rotation = bones[bone]
            if parent:
                above, turn = bones[parent]
                position, rotation = rotate(inverse(turn), position - above), multiply(inverse(turn), rotation)
            elements.append(_element(_BONE, bone, position, rotation))
        return _datagrams(elements, self.MOST_BYTES)

    def _trunk(self, rotations: Dict[str, np.ndarray], at: np.ndarray) -> Dict[str, Transform]:
        """The pelvis turns with the line of the hips and the chest with that of the shoulders; the spine is
        half way. Joints that the motion does not have are placed between hips and neck."""
        def place(name: str, otherwise: np.ndarray) -> np.ndarray:
            return at[self._joints[name]] if name in self._joints else otherwise

        def side(name: str) -> np.ndarray:
            return at[self._joints[f"left_{name}"]] - at[self._joints[f"right_{name}"]]

        neck, head = place("neck", at[0]), place("head", at[0])
        low = (at[self._joints["left_hip"]] + at[self._joints["right_hip"]]) / 2
        up = neck - low
        hips, chest = _facing(side("hip"), up), _facing(side("shoulder"), up)
        spine = unit(hips + chest * (1 if hips @ chest >= 0 else -1), hips)
        towards_head = rotations.get("neck_to_head", rotations["neck"])
        return {"Hips": (place("hips", low + 0.23 * up), hips),
                "Spine": (place("spine", low + 0.5 * up), spine),
                "Chest": (place("chest", low + 0.77 * up), chest),
                "Neck": (neck, towards_head), "Head": (head, rotations["head"])}


def _facing(left: np.ndarray, up: np.ndarray) -> np.ndarray:
    """The rotation from a person who faces +z, whose left is +x, to one with these directions."""
    x = unit(left, (1, 0, 0))
    z = unit(np.cross(x, up), (0, 0, 1))
    matrix = np.stack([x, np.cross(z, x), z], axis=1)
    # Shepperd's method: the largest component first.
    trace = np.array([matrix[0, 0], matrix[1, 1], matrix[2, 2], np.trace(matrix)])
    largest = int(np.argmax(trace))
    q = np.zeros(4)
    if largest == 3:
        q[:] = (matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1],
                1 + trace[3])
    else:
        i, j, k = largest, (largest + 1) % 3, (largest + 2) % 3
        q[i] = 1 + 2 * matrix[i, i] - trace[3]
        q[j], q[k] = matrix[j, i] + matrix[i, j], matrix[k, i] + matrix[i, k]
        q[3] = matrix[k, j] - matrix[j, k]
    return unit(q, IDENTITY)


def _element(address: str, name: str, position: np.ndarray, rotation: np.ndarray) -> bytes:
    """A transform in Unity's axes: mirrored in x."""
    return osc.message(address, "sfffffff", name, *(position * MIRROR), *(rotation * (1, -1, -1, 1)))


def _datagrams(elements: Sequence[bytes], most_bytes: int) -> List[bytes]:
    datagrams, size = [[]], 16
    for element in elements:
        if size + len(element) > most_bytes:
            datagrams.append([])
            size = 16
        datagrams[-1].append(element)
        size += len(element)
    return [osc.bundle(some) for some in datagrams]
