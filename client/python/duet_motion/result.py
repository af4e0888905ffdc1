"""Results from a server."""

from __future__ import annotations

import dataclasses
from typing import Any, Optional, Tuple, Type, TypeVar, cast

import grpc
import numpy as np
import numpy.typing as npt

from duet_motion.errors import MalformedReplyError
from duet_motion.motion import Motion, Positions
from duet_motion.v1 import model_pb2, reaction_pb2, synthesis_pb2

_Kind = TypeVar("_Kind")


@dataclasses.dataclass(frozen=True)
class Timings:
    """Durations of a call in seconds."""

    first_chunk: float
    """Time from the call to its first frames, including retries."""
    total: float
    """Time from the call to its last frame, including retries."""
    queue: float
    """Time in the server's queue, over all windows."""
    compute: float
    """Time in the network, over all windows."""


@dataclasses.dataclass(frozen=True)
class RigJoint:
    """A joint of the follower's hierarchy in its rest pose.

    Args:
        name: unique in the rig; a joint of the follower has the same name here.
        parent: index of the parent in the rig; -1 for the root, which is the first joint.
        offset: from the parent at rest, in the leader's unit and axes; zero for the root.
        joint: index in the follower's ``joint_names`` of the joint at the same position.
    """

    name: str
    parent: int
    offset: Tuple[float, float, float]
    joint: int


@dataclasses.dataclass(frozen=True, eq=False)
class JointRotations:
    """A motion as rotations of a hierarchy, in the leader's unit and axes (docs/rotations.md).

    Args:
        rig: the joints at rest, each after its parent.
        rotations: ``[frames, rig joints, 4]``: unit quaternions x, y, z, w, relative to the parent's;
            the root's is its rotation in the world.
    """

    rig: Tuple[RigJoint, ...]
    rotations: npt.NDArray[np.float32]

    @property
    def rotations_6d(self) -> npt.NDArray[np.float32]:
        """``[frames, rig joints, 6]``: the first two columns of each rotation's matrix, one after
        the other (Zhou et al. 2019)."""
        x, y, z, w = np.moveaxis(self.rotations, -1, 0)
        return np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y),
                         2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], axis=-1)


@dataclasses.dataclass(frozen=True, eq=False)
class FollowerChunk:
    """Consecutive frames of the follower."""

    first_frame: int
    positions: Positions
    """``[frames, joints, 3]`` in the leader's joints, unit and world."""
    rotations: Optional[JointRotations] = None
    """The rotations of these frames, if the request asks for them."""


@dataclasses.dataclass(frozen=True)
class FrameRun:
    """Consecutive frames."""

    first_frame: int
    frame_count: int


@dataclasses.dataclass(frozen=True)
class MotionGrade:
    """What a viewer would notice in a follower: shares of its frames, 0 to 1. 0 is perfect."""

    twisted: float
    """Frames in which the shoulders are turned against the hips by more than 45 degrees."""
    skating: float
    """Frames in which both ankles move faster than 10 cm/s. People who step and turn do so in some
    frames; compare it with ``leader_skating``."""
    leader_skating: float
    """The same share of the leader's frames."""
    overlapping: float
    """Frames in which the heads or the trunks overlap."""
    bad_runs: Tuple[FrameRun, ...]
    """The frames that are twisted or overlap, in ascending order. At most 64 runs; later ones are
    left out."""


@dataclasses.dataclass(frozen=True, eq=False)
class SynthesisResult:
    """A follower, with the model and settings that produced it."""

    leader: Motion
    """The leader of the request."""
    follower: Motion
    """In the leader's joints, rate, unit and world, with the same number of frames."""
    model_name: str
    model_version: int
    interaction_classes: Tuple[str, ...]
    """Every class of the model."""
    request_id: str
    """Identifies the call in the server's log."""
    seed: int
    """The seed that the server used."""
    variety: float
    """The variety that the server used."""
    candidates: int
    """Number of samples that the model drew for each window."""
    cleaned_up: bool
    """Whether the server corrected the follower, by request or by default."""
    unfamiliarity: Optional[float]
    """Distance of the leader from the training leaders; 1 is their 90th percentile. None if the
    model cannot measure it."""
    grade: Optional[MotionGrade]
    """What a viewer would notice in the follower. None if the model's skeleton lacks hips, shoulders
    or feet."""
    window_count: int
    """Number of windows that the network computed."""
    attempt_count: int
    timings: Timings
    rotations: Optional[JointRotations] = None
    """The follower's joint rotations, if the request asks for them."""
    constraint_metres: Tuple[float, ...] = ()
    """Distance that remains at each of the request's constraints, in metres."""


@dataclasses.dataclass(frozen=True)
class ModelInfo:
    """A model version that a server serves."""

    name: str
    version: int
    version_labels: Tuple[str, ...]
    is_default: bool
    interaction_classes: Tuple[str, ...]
    joint_names: Tuple[str, ...]
    bones: Tuple[Tuple[int, int], ...]
    """Parent and child, as indices into ``joint_names``."""
    root_joint: str
    frame_rate_hz: float
    """The network's rate; the server resamples other rates."""
    window_frames: int
    accepts_follower_start: bool
    samples: bool
    """Answers depend on the request's seed and variety."""
    description: str
    terms: str = ""
    """Terms of use of the weights and of their output; empty if the server states none."""
    weights_sha256: str = ""
    """SHA-256 of the weights file, lower-case hexadecimal; empty if the server does not report
    it."""
    free_for_all_uses: bool = False
    """Anybody may use and pass on the weights and their output for any purpose."""


@dataclasses.dataclass(frozen=True)
class RequestLimits:
    """Limits of a request."""

    min_frame_rate_hz: float
    max_frame_rate_hz: float
    min_frames: int
    max_duration_seconds: float
    max_chunk_frames: int
    max_keyframes: int
    max_abs_weight: float
    max_variety: float
    max_candidates: int
    max_request_bytes: int
    max_constraints: int = 0


@dataclasses.dataclass(frozen=True)
class ModelDetails:
    """One model version and its request limits."""

    model: ModelInfo
    limits: RequestLimits


def _read(message: Any, kind: Type[_Kind], **given: Any) -> _Kind:
    """A value whose fields have the names of a message's, except those that are given."""
    values = {field.name: getattr(message, field.name) for field in dataclasses.fields(cast(Any, kind))
              if field.name not in given}
    return kind(**{name: value if isinstance(value, (str, float, int)) else tuple(value)
                   for name, value in values.items()}, **given)


def model_from_proto(model: model_pb2.Model) -> ModelInfo:
    """Raises MalformedReplyError if a bone names a joint that does not exist."""
    bones = tuple((bone.parent_joint, bone.child_joint) for bone in model.bones)
    joints = len(model.joint_names)
    for bone in bones:
        if max(bone) >= joints:
            raise MalformedReplyError(
                grpc.StatusCode.INTERNAL,
                f"the server's reply is malformed: bones of {model.name}@{model.version}: expected "
                f"joints 0 to {joints - 1}, got {bone[0]} and {bone[1]}")
    return _read(model, ModelInfo, bones=bones)


def grade_from_proto(grade: reaction_pb2.MotionGrade) -> MotionGrade:
    return _read(grade, MotionGrade, bad_runs=tuple(
        FrameRun(run.first_frame, run.frame_count) for run in grade.bad_runs))


def details_from_proto(response: synthesis_pb2.GetModelResponse) -> ModelDetails:
    limits = _read(response.limits, RequestLimits, max_keyframes=response.limits.max_label_keyframes)
    return ModelDetails(model_from_proto(response.model), limits)
