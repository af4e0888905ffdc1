"""What is asked of a server."""

from __future__ import annotations

import dataclasses
import numbers
import reprlib
from typing import Mapping, Optional

import numpy as np
import numpy.typing as npt

from duet._wire import CLEAN_UP, PRIORITIES, UNITS, UP_AXES
from duet.motion import Motion
from duet.v1 import model_pb2, motion_pb2, synthesis_pb2

Labels = Mapping[str, float]
"""Weights by interaction class: 1 wanted, 0 neutral, -1 avoided, in [-2, 2]."""


@dataclasses.dataclass(frozen=True, eq=False)
class SynthesisRequest:
    """A follower to synthesise.

    Raises:
        ValueError: a field is malformed in a way that no server needs to be asked about.
    """

    leader: Motion
    """Its joints are those of the model (:meth:`duet.Client.get_model`), in any order."""
    labels: Optional[Labels] = None
    """The reaction that is wanted, for the whole clip: ``{"hug": 1, "push": 0.5}``."""
    keyframes: Optional[Mapping[int, Labels]] = None
    """Or weights by frame: linear in between, constant before the first and after the last."""
    seed: int = 0
    """Which answer of a model that samples: the same request with the same seed has the same answer
    on the same server."""
    variety: float = 1.0
    """How varied such answers are over the seeds: 0 the typical one, 1 as varied as people."""
    model: str = ""
    """``"sbu"``, ``"sbu@2"`` for a version, ``"sbu:stable"`` for a label; empty: the server's
    default."""
    clean_up: Optional[bool] = None
    """Whether the follower is corrected so that it stands, keeps its feet still and keeps out of
    the leader. None: the server's choice."""
    follower_start: Optional[npt.ArrayLike] = None
    """Where the follower is in the first frame, in the leader's world: its root joint ``[3]``, or
    every joint ``[joints, 3]`` in the leader's order."""
    partner_direction: Optional[npt.ArrayLike] = None
    """The horizontal direction from the leader to where the follower should be, ``[3]``."""
    priority: str = "interactive"
    """``"bulk"`` yields to interactive calls, and waits when the server is full."""
    chunk_frames: Optional[int] = None
    """Frames in one chunk of the reply. None: the server chooses."""
    request_id: str = ""
    """Names the call in the server's log. Empty: the server makes one."""

    def __post_init__(self) -> None:
        if not isinstance(self.leader, Motion):
            raise ValueError(f"leader: {_short(self.leader)}, wanted a duet.Motion")
        _check_labels("labels", self.labels or {})
        if not isinstance(self.keyframes or {}, Mapping):
            raise ValueError(f"keyframes: {_short(self.keyframes)}, wanted labels by frame, such as "
                             "{0: {'hug': 1}}")
        if self.priority not in PRIORITIES:
            raise ValueError(f"priority: {self.priority!r}, wanted one of {', '.join(PRIORITIES)}")
        if self.chunk_frames is not None and self.chunk_frames < 1:
            raise ValueError(f"chunk_frames: {self.chunk_frames}, wanted 1 or more")
        if not 0 <= self.seed < 2**64:
            raise ValueError(f"seed: {self.seed}, wanted 0 to 2^64 - 1")
        for frame, labels in (self.keyframes or {}).items():
            if not isinstance(frame, numbers.Integral) or frame < 0:
                raise ValueError(f"keyframes: frame {_short(frame)}, wanted 0 or more")
            _check_labels(f"keyframes[{frame}]", labels)
        to_selector(self.model)
        _check_shape("follower_start", self.follower_start, ((3,), (self.leader.joint_count, 3)))
        _check_shape("partner_direction", self.partner_direction, ((3,),))


def to_selector(model: str) -> model_pb2.ModelSelector:
    """The model that ``NAME``, ``NAME@VERSION`` or ``NAME:LABEL`` chooses."""
    selector = model_pb2.ModelSelector()
    if "@" in model:
        selector.name, _, version = model.partition("@")
        if not version.isdecimal() or not 1 <= int(version) < 2**32:
            raise ValueError(f"model: {model!r}, wanted a version of 1 or more after the @")
        selector.version = int(version)
    elif ":" in model:
        selector.name, _, selector.version_label = model.partition(":")
        if not selector.version_label:
            raise ValueError(f"model: {model!r}, wanted a label after the colon")
    else:
        selector.name = model
    return selector


def to_proto(request: SynthesisRequest) -> synthesis_pb2.SynthesizeRequest:
    """The request as it goes over the wire."""
    out = synthesis_pb2.SynthesizeRequest(
        model=to_selector(request.model), leader=_leader(request.leader), seed=request.seed,
        variety=request.variety, clean_up=CLEAN_UP[request.clean_up],
        priority=PRIORITIES[request.priority], chunk_frames=request.chunk_frames)
    _fill(request.labels or {}, out.label_vector)
    for frame, labels in sorted((request.keyframes or {}).items()):
        _fill(labels, out.label_keyframes.add(frame=frame).label_vector)
    if request.follower_start is not None:
        _fill_start(request.follower_start, out.follower_start)
    if request.partner_direction is not None:
        x, y, z = _floats(request.partner_direction)
        out.partner_direction.CopyFrom(motion_pb2.Direction(x=x, y=y, z=z))
    return out


def _leader(leader: Motion) -> motion_pb2.Motion:
    return motion_pb2.Motion(
        joint_names=leader.joint_names, frame_rate_hz=leader.frame_rate_hz,
        unit=UNITS[leader.unit], up_axis=UP_AXES[leader.up_axis], frame_count=leader.frame_count,
        positions=_floats(leader.positions))


def _fill(labels: Labels, vector: synthesis_pb2.LabelVector) -> None:
    """Leaves the vector absent where there are no labels: the server says what is missing."""
    for interaction_class, weight in labels.items():
        vector.weights.add(interaction_class=interaction_class, weight=weight)


def _fill_start(start: npt.ArrayLike, out: motion_pb2.FollowerStart) -> None:
    values = _floats(start)
    if np.ndim(start) == 1:
        out.root_position.CopyFrom(motion_pb2.Point(x=values[0], y=values[1], z=values[2]))
    else:
        out.pose.positions.extend(values)


def _floats(values: npt.ArrayLike) -> list[float]:
    flat: list[float] = np.asarray(values, dtype=np.float32).ravel().tolist()
    return flat


def _check_labels(name: str, labels: Labels) -> None:
    if not isinstance(labels, Mapping):
        raise ValueError(f"{name}: {_short(labels)}, wanted weights by class, such as "
                         "{'hug': 1}")
    for interaction_class, weight in labels.items():
        if not isinstance(interaction_class, str):
            raise ValueError(f"{name}: class {_short(interaction_class)}, wanted a str")
        if not isinstance(weight, numbers.Real):
            raise ValueError(f"{name}[{interaction_class!r}]: {_short(weight)}, wanted a number")


def _short(value: object) -> str:
    """What came, in one short line."""
    return reprlib.repr(value)


def _check_shape(name: str, values: Optional[npt.ArrayLike],
                 wanted: tuple[tuple[int, ...], ...]) -> None:
    if values is not None and np.shape(values) not in wanted:
        raise ValueError(f"{name}: shape {np.shape(values)}, wanted "
                         f"{' or '.join(map(str, wanted))}")
