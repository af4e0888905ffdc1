"""Reads the rig and the rotations of replies and of live sessions.

The counterpart of the C++ client's client/internal/rotations.h. Raises ValueError with the
field, what was expected and what was received.
"""

from __future__ import annotations

from typing import List, Optional, Sequence, Set, Tuple

import numpy as np
import numpy.typing as npt

from duet_motion.result import JointRotations, RigJoint
from duet_motion.v1 import live_pb2, motion_pb2

Rotations = npt.NDArray[np.float32]
_NORM_TOLERANCE = 1e-3  # of a quaternion's norm from 1


def read_rig(rig: Sequence[motion_pb2.RigJoint], joint_count: int,
             rig_field: str = "header.rig") -> Tuple[RigJoint, ...]:
    """Each joint comes after its parent; names are unique."""
    joints: List[RigJoint] = []
    names: Set[str] = set()
    for index, joint in enumerate(rig):
        field = f"{rig_field}[{index}]"
        lowest, highest = (-1, -1) if index == 0 else (0, index - 1)
        if not lowest <= joint.parent <= highest:
            expected = "-1" if index == 0 else f"0 to {highest}"
            raise ValueError(f"{field}.parent: expected {expected}, got {joint.parent}")
        if joint.joint >= joint_count:
            raise ValueError(f"{field}.joint: expected 0 to {joint_count - 1}, got {joint.joint}")
        offset = (joint.offset.x, joint.offset.y, joint.offset.z)
        if not np.isfinite(offset).all():
            raise ValueError(f"{field}.offset: expected finite values, got {offset}")
        if joint.name in names:
            raise ValueError(f"{field}.name: expected a name once, got {joint.name!r} again")
        names.add(joint.name)
        joints.append(RigJoint(joint.name, joint.parent, offset, joint.joint))
    return tuple(joints)


def read_rotations(values: Sequence[float], frames: int, rig_joints: int,
                   field: str = "chunk.rotations") -> Rotations:
    """``[frames, rig joints, 4]``: unit quaternions x, y, z, w."""
    shape = (frames, rig_joints, 4)
    if len(values) != np.prod(shape):
        raise ValueError(f"{field}: expected {np.prod(shape)} values for {frames} frames, got "
                         f"{len(values)}")
    rotations = np.array(values, dtype=np.float32).reshape(shape)
    norms = np.linalg.norm(rotations, axis=-1).ravel()
    unit = np.abs(norms - 1) <= _NORM_TOLERANCE  # False for NaN
    if not unit.all():
        bad = int(np.argmin(unit))
        raise ValueError(f"{field}[{4 * bad}..{4 * bad + 3}]: expected a unit quaternion, "
                         f"got norm {norms[bad]}")
    return rotations


class LiveRotations:
    """The rotations of a session over all its streams.

    The wire has every quaternion with w >= 0; here each has the sign that is nearer to the frame
    before."""

    def __init__(self, wanted: bool, joint_count: int) -> None:
        self._wanted, self._joint_count = wanted, joint_count
        self._has_rig = False  # of this stream
        self._rig: Tuple[RigJoint, ...] = ()
        self._last: Optional[Rotations] = None

    def begin(self) -> None:
        """The next message is the first one of a stream, which has the rig."""
        self._has_rig = False

    def read(self, frames: live_pb2.FollowerFrames, known: int) -> Optional[JointRotations]:
        """The rotations of the frames from ``known`` on; None if they are not wanted."""
        expects_rig = self._wanted and not self._has_rig
        if bool(frames.rig) != expects_rig:
            raise ValueError(
                "frames.rig: expected joints in the first frames of a stream, got none; does the "
                "server know reply_rotations?" if expects_rig else
                "frames.rig: expected joints only for rotations, in the first frames, got some")
        if expects_rig:
            self._rig = read_rig(frames.rig, self._joint_count, "frames.rig")
            self._has_rig = True
        rotations = read_rotations(frames.rotations, frames.frame_count, len(self._rig),
                                   "frames.rotations")[known:]
        if not self._wanted or not len(rotations):
            return None
        return JointRotations(self._rig, self._with_near_signs(rotations))

    def _with_near_signs(self, rotations: Rotations) -> Rotations:
        last = self._last
        for frame in rotations:
            if last is not None:
                frame *= np.where((last * frame).sum(axis=-1, keepdims=True) < 0, -1, 1)
            last = frame
        self._last = last
        return rotations
