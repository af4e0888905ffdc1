"""Reads the joint rotations of a live session over all its streams.

The counterpart of the C++ client's client/internal/rotations.h. Raises ValueError with the
field, what was expected and what was received.
"""

from __future__ import annotations

from typing import Optional, Tuple

import numpy as np

from duet_motion._rotations import Rotations, read_rig, read_rotations
from duet_motion.result import JointRotations, RigJoint
from duet_motion.v1 import live_pb2


class LiveRotations:
    """The wire has every quaternion with w >= 0; here each has the sign that is nearer to the frame
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
