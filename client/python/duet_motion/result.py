"""What a server answers."""

from __future__ import annotations

import dataclasses
from typing import Optional, Tuple

import grpc

from duet_motion.errors import MalformedReplyError
from duet_motion.motion import Motion, Positions
from duet_motion.v1 import model_pb2, synthesis_pb2


@dataclasses.dataclass(frozen=True)
class Timings:
    """Where the time of a call went, in seconds."""

    first_chunk: float
    """From the call to its first frames, retries included."""
    total: float
    """From the call to its last frame, retries included."""
    queue: float
    """Waiting in the server, over all windows."""
    compute: float
    """In the network, over all windows."""


@dataclasses.dataclass(frozen=True, eq=False)
class FollowerChunk:
    """Consecutive frames of the follower, as they arrive."""

    first_frame: int
    positions: Positions
    """``[frames, joints, 3]`` in the leader's joints, unit and world."""


@dataclasses.dataclass(frozen=True, eq=False)
class SynthesisResult:
    """A follower, and who made it."""

    leader: Motion
    """The request's."""
    follower: Motion
    """In the leader's joints, rate, unit and world, with as many frames."""
    model_name: str
    model_version: int
    interaction_classes: Tuple[str, ...]
    """Every class of the model."""
    request_id: str
    """As in the server's log."""
    seed: int
    """That the server used."""
    variety: float
    """That the server used."""
    cleaned_up: bool
    """Whether the server corrected the follower, asked to or not."""
    unfamiliarity: Optional[float]
    """How far the request is from what the model was trained on: 1 as far as the farthest tenth of
    the training leaders. None when the model does not know."""
    window_count: int
    """Network windows that were evaluated."""
    attempt_count: int
    timings: Timings


@dataclasses.dataclass(frozen=True)
class ModelInfo:
    """A model version that a server answers with."""

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
    """The network's own; any other is resampled."""
    window_frames: int
    accepts_follower_start: bool
    samples: bool
    """Answers depend on the request's seed and variety."""
    description: str
    terms: str = ""
    """Terms of using the weights, and so of what they make; empty if the server states none."""
    weights_sha256: str = ""
    """Of the file of weights, lower-case hexadecimal; empty if the server does not say."""


@dataclasses.dataclass(frozen=True)
class RequestLimits:
    """What a request must keep to."""

    min_frame_rate_hz: float
    max_frame_rate_hz: float
    min_frames: int
    max_duration_seconds: float
    max_chunk_frames: int
    max_keyframes: int
    max_abs_weight: float
    max_variety: float
    max_request_bytes: int


@dataclasses.dataclass(frozen=True)
class ModelDetails:
    """One model version, and the limits that a request to it must keep."""

    model: ModelInfo
    limits: RequestLimits


def model_from_proto(model: model_pb2.Model) -> ModelInfo:
    """Raises MalformedReplyError where a bone has no joint."""
    bones = tuple((bone.parent_joint, bone.child_joint) for bone in model.bones)
    joints = len(model.joint_names)
    for bone in bones:
        if max(bone) >= joints:
            raise MalformedReplyError(
                grpc.StatusCode.INTERNAL,
                f"the server's model {model.name}@{model.version} has a bone from joint {bone[0]} "
                f"to {bone[1]}, wanted 0 to {joints - 1}")
    return ModelInfo(
        name=model.name, version=model.version, version_labels=tuple(model.version_labels),
        is_default=model.is_default, interaction_classes=tuple(model.interaction_classes),
        joint_names=tuple(model.joint_names), bones=bones, root_joint=model.root_joint,
        frame_rate_hz=model.frame_rate_hz, window_frames=model.window_frames,
        accepts_follower_start=model.accepts_follower_start, samples=model.samples,
        description=model.description, terms=model.terms, weights_sha256=model.weights_sha256)


def details_from_proto(response: synthesis_pb2.GetModelResponse) -> ModelDetails:
    limits = response.limits
    return ModelDetails(model_from_proto(response.model), RequestLimits(
        min_frame_rate_hz=limits.min_frame_rate_hz, max_frame_rate_hz=limits.max_frame_rate_hz,
        min_frames=limits.min_frames, max_duration_seconds=limits.max_duration_seconds,
        max_chunk_frames=limits.max_chunk_frames, max_keyframes=limits.max_label_keyframes,
        max_abs_weight=limits.max_abs_weight, max_variety=limits.max_variety,
        max_request_bytes=limits.max_request_bytes))
