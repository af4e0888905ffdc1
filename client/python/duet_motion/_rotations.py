"""Reads the rig and the rotations of a reply.

The counterpart of the C++ client's client/internal/rotations.h. Raises ValueError with the
field, what was expected and what was received.
"""

from __future__ import annotations

from typing import List, Sequence, Set, Tuple

import numpy as np
import numpy.typing as npt

from duet_motion.result import RigJoint
from duet_motion.v1 import motion_pb2

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
