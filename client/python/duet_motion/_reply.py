"""Checks a response stream message by message and collects the follower.

A call whose stream broke is repeated from its first frame. ``start_stream`` starts each stream, and
frames that the caller already has are not returned again. The counterpart of the C++ client's
ReplyAssembler (client/internal/reply_assembler.h).
"""

from __future__ import annotations

from typing import List, Optional, Sequence, Set, Tuple, Union

import grpc
import numpy as np
import numpy.typing as npt

from duet_motion.errors import DuetError, MalformedReplyError, make_error
from duet_motion.motion import UNITS, UP_AXES, Motion, Positions
from duet_motion.result import (FollowerChunk, JointRotations, RigJoint, SynthesisResult, Timings,
                                grade_from_proto)
from duet_motion.v1 import live_pb2, motion_pb2, reaction_pb2, synthesis_pb2

Rotations = npt.NDArray[np.float32]
_NORM_TOLERANCE = 1e-3  # of a quaternion's norm from 1

# Codes with which a proxy or a stopping server resets streams. The service always adds a reason to
# these codes.
_RESETS = (grpc.StatusCode.INTERNAL, grpc.StatusCode.UNKNOWN, grpc.StatusCode.CANCELLED)


def is_broken_connection(error: DuetError) -> bool:
    if error.code is grpc.StatusCode.UNAVAILABLE:
        return True
    return error.code in _RESETS and not error.reason


def malformed(what: str) -> MalformedReplyError:
    return MalformedReplyError(grpc.StatusCode.INTERNAL,
                               f"the server's reply is malformed: {what}")


def check_format(header: Union[synthesis_pb2.SynthesisHeader, live_pb2.LiveHeader],
                 leader: Motion) -> None:
    """Raises MalformedReplyError unless the follower has the leader's joints, rate and world."""
    if tuple(header.joint_names) != leader.joint_names:
        raise malformed("header.joint_names: expected the leader's, got others")
    if header.frame_rate_hz != leader.frame_rate_hz:
        raise malformed("header.frame_rate_hz: expected the leader's "
                        f"{leader.frame_rate_hz}, got {header.frame_rate_hz}")
    if (header.unit, header.up_axis) != (UNITS[leader.unit], UP_AXES[leader.up_axis]):
        raise malformed(f"header.unit and up_axis: expected {leader.unit} and "
                        f"{leader.up_axis}, got {header.unit} and {header.up_axis}")


def end_of_stream(error: Optional[DuetError], is_complete: bool, has_header: bool,
                  broke_off: str) -> Optional[DuetError]:
    """The error of a stream that ended with ``error`` or without one; None if the reply was complete,
    even if the stream broke after it."""
    if error is not None and not is_broken_connection(error):
        return error
    if is_complete:
        return None
    if error is None:
        return make_error(grpc.StatusCode.UNAVAILABLE, broke_off)
    if not has_header:
        return error
    return make_error(grpc.StatusCode.UNAVAILABLE, f"{broke_off}: {error.message}",
                      violations=error.violations, reason=error.reason, retry_delay=error.retry_delay)


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


class ReplyAssembler:
    """The reply of one call, over all its streams."""

    def __init__(self, leader: Motion, rotations: bool = False, constraints: int = 0) -> None:
        self._leader = leader
        self._wants_rotations = rotations
        self._constraints = constraints
        self.handed_out = 0
        """Number of frames that the caller has, over all streams."""
        self.start_stream()

    def start_stream(self) -> None:
        self.header: Optional[synthesis_pb2.SynthesisHeader] = None
        self._summary: Optional[synthesis_pb2.SynthesisSummary] = None
        self._chunks: List[Positions] = []
        self._rig: Tuple[RigJoint, ...] = ()
        self._rotations: List[Rotations] = []
        self.received = 0

    def accept(self, response: synthesis_pb2.SynthesizeResponse) -> Optional[FollowerChunk]:
        """Accepts a message and returns its frames that the caller does not have yet, if any.

        Raises MalformedReplyError if the message violates the API.
        """
        if self._summary is not None:
            raise malformed("a message after the summary")
        kind = response.WhichOneof("payload")
        if kind == "header":
            self._accept_header(response.header)
        elif kind == "chunk":
            return self._accept_chunk(response.chunk)
        elif kind == "summary":
            self._accept_summary(response.summary)
        else:
            raise malformed("a message without a payload")
        return None

    def _accept_header(self, header: synthesis_pb2.SynthesisHeader) -> None:
        leader = self._leader
        if self.header is not None:
            raise malformed("a second header")
        check_format(header, leader)
        if header.frame_count != leader.frame_count:
            raise malformed(f"header.frame_count: expected the leader's {leader.frame_count}, got "
                             f"{header.frame_count}")
        if self._wants_rotations != bool(header.rig):
            wanted = ("joints for the rotations that the request asks for, got none; does the "
                      "server know reply_rotations?" if self._wants_rotations
                      else "none without reply_rotations, got joints")
            raise malformed(f"header.rig: expected {wanted}")
        try:
            self._rig = read_rig(header.rig, leader.joint_count)
        except ValueError as error:
            raise malformed(str(error)) from error
        self.header = header

    def _accept_chunk(self, chunk: synthesis_pb2.MotionChunk) -> Optional[FollowerChunk]:
        positions = self._read_chunk(chunk)
        try:
            rotations = read_rotations(chunk.rotations, chunk.frame_count, len(self._rig))
        except ValueError as error:
            raise malformed(f"{error}, in the chunk of frame {chunk.first_frame}") from error
        self._chunks.append(positions)
        self._rotations.append(rotations)
        first, self.received = self.received, self.received + chunk.frame_count
        if self.received <= self.handed_out:
            return None
        known = max(self.handed_out - first, 0)
        new = FollowerChunk(first + known, positions[known:],
                            JointRotations(self._rig, rotations[known:]) if self._rig else None)
        self.handed_out = self.received
        return new

    def _read_chunk(self, chunk: synthesis_pb2.MotionChunk) -> Positions:
        if self.header is None:
            raise malformed("a chunk before the header")
        if chunk.first_frame != self.received:
            raise malformed(f"chunk.first_frame: expected {self.received}, got "
                             f"{chunk.first_frame}")
        left = self._leader.frame_count - self.received
        if not 1 <= chunk.frame_count <= left:
            raise malformed(f"chunk.frame_count: expected 1 to {left}, got {chunk.frame_count}")
        shape = (chunk.frame_count, self._leader.joint_count, 3)
        if len(chunk.positions) != np.prod(shape):
            raise malformed(f"chunk.positions: expected {np.prod(shape)} values for "
                             f"{chunk.frame_count} frames, got {len(chunk.positions)}")
        positions = np.array(chunk.positions, dtype=np.float32).reshape(shape)
        finite = np.isfinite(positions.ravel())
        if not finite.all():
            bad = int(np.argmin(finite))
            raise malformed(f"chunk.positions[{bad}]: expected a finite value, got "
                             f"{chunk.positions[bad]} in the chunk of frame {chunk.first_frame}")
        return positions

    def _accept_summary(self, summary: synthesis_pb2.SynthesisSummary) -> None:
        if self.header is None:
            raise malformed("a summary before the header")
        if self.received != self._leader.frame_count:
            raise malformed(f"a summary after {self.received} of {self._leader.frame_count} "
                             "frames")
        if summary.frame_count != self.received:
            raise malformed(f"summary.frame_count: expected {self.received}, got "
                             f"{summary.frame_count}")
        if summary.chunk_count != len(self._chunks):
            raise malformed(f"summary.chunk_count: expected {len(self._chunks)}, got "
                             f"{summary.chunk_count}")
        metres = summary.constraint_metres
        if len(metres) != self._constraints:
            raise malformed(f"summary.constraint_metres: expected {self._constraints} values, one "
                             f"for each of constraints, got {len(metres)}; does the server know "
                             "constraints?")
        self._summary = summary

    def end_stream(self, error: Optional[DuetError]) -> Optional[DuetError]:
        """Handles the end of a stream; returns None if the reply is complete, else its error."""
        return end_of_stream(error, self._summary is not None, self.header is not None,
                             f"the reply ended without a summary, after {self.received} of "
                             f"{self._leader.frame_count} frames")

    def result(self, attempts: int, first_chunk: float, total: float) -> SynthesisResult:
        """The complete reply. Requires that end_stream returned None."""
        assert self.header is not None and self._summary is not None
        header, summary = self.header, self._summary
        return SynthesisResult(
            leader=self._leader,
            follower=self._leader.with_positions(np.concatenate(self._chunks)),
            model_name=header.model_name, model_version=header.model_version,
            interaction_classes=tuple(header.interaction_classes), request_id=header.request_id,
            seed=header.seed, variety=header.variety,
            # Servers without candidates draw one sample and do not set the field.
            candidates=max(1, header.candidates),
            cleaned_up=header.clean_up == reaction_pb2.CLEAN_UP_ON,
            unfamiliarity=(summary.unfamiliarity if summary.HasField("unfamiliarity") else None),
            grade=grade_from_proto(summary.grade) if summary.HasField("grade") else None,
            window_count=summary.window_count, attempt_count=attempts,
            timings=Timings(first_chunk, total, summary.queue_seconds, summary.compute_seconds),
            rotations=(JointRotations(self._rig, np.concatenate(self._rotations)) if self._rig
                       else None),
            constraint_metres=tuple(summary.constraint_metres))
