"""Requests to a server."""

from __future__ import annotations

import dataclasses
import numbers
import re
import reprlib
from typing import TYPE_CHECKING, Mapping, Optional, Sequence, Union

import numpy as np
import numpy.typing as npt

from duet_motion.motion import (UNITS, UP_AXES, Motion, checked_array, checked_number, finite_number,
                                first_not_finite)
from duet_motion.v1 import model_pb2, motion_pb2, reaction_pb2, synthesis_pb2

if TYPE_CHECKING:
    from duet_motion.live import LiveRequest

Labels = Mapping[str, float]
"""Weights by interaction class, from -2 to 2: 1 requests a class, 0 is neutral, -1 avoids it."""

PRIORITIES = {"interactive": synthesis_pb2.PRIORITY_INTERACTIVE, "bulk": synthesis_pb2.PRIORITY_BULK}
CLEAN_UP = {None: reaction_pb2.CLEAN_UP_UNSPECIFIED, True: reaction_pb2.CLEAN_UP_ON,
            False: reaction_pb2.CLEAN_UP_OFF}

_REQUEST_ID = re.compile(r"[!-~]{1,128}")


@dataclasses.dataclass(frozen=True, eq=False)
class Constraint:
    """Where a joint of the follower must be in one frame.

    Args:
        joint: one of the leader's ``joint_names``. A joint of an arm or a leg rotates the limb; any
            other joint moves the whole body.
        frame: a frame of the leader.
        position: ``[3]`` in the leader's world and unit.
        softness: the share of the distance that may remain, 0 to 1. 1 moves nothing, but candidates
            that are near are still preferred.

    Raises:
        ValueError: an argument is invalid for every server. The message has the form
            ``field: expected ..., got ...``.
    """

    joint: str
    frame: int
    position: npt.ArrayLike
    softness: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.joint, str):
            raise ValueError(f"joint: expected a str, got {short(self.joint)}")
        check_integer("frame", self.frame, 0, 2**32 - 1)
        if self.position is None:
            raise ValueError("position: expected the shape (3,), got None")
        check_points("position", self.position, ((3,),))
        softness = finite_number(self.softness)
        if softness is None or not 0 <= softness <= 1:
            raise ValueError(f"softness: expected a number from 0 to 1, got {short(self.softness)}")


@dataclasses.dataclass(frozen=True, eq=False)
class SynthesisRequest:
    """A request for a follower.

    Args:
        leader: the leader's motion: positions ``[frames, joints, 3]`` with joint names, rate, unit
            and axis. Its joints must be those of the model
            (:meth:`duet_motion.Client.get_model`), in any order.
        labels: weights by interaction class for the whole clip, from -2 to 2, such as
            ``{"hug": 1, "push": 0.5}``: 1 requests a class, 0 is neutral, -1 avoids it.
        keyframes: instead of ``labels``, weights by frame number: interpolated linearly, constant
            before the first and after the last.
        seed: selects an answer of a model that samples, 0 to 2^64 - 1. The same request with the
            same seed gets the same answer from the same server. None: derived from the leader;
            ``SynthesisResult.seed`` has it.
        variety: how much answers differ between seeds, 0 to 2: 0 gives the typical answer, 1 as
            much variety as people have.
        reaction: how much the leader's motion moves the follower, 0 to 2: 0 not at all, 1 as the
            model has learnt. Other values than 1 take longer.
        model: ``"sbu"``, ``"sbu@3"`` for a version, ``"sbu:stable"`` for a version label; empty:
            the server's default.
        clean_up: whether the server corrects the follower: upright, without foot sliding, without
            overlap with the leader. None: the server's default.
        follower_start: the follower's position in the first frame, in the leader's world and unit:
            its root joint ``[3]``, or every joint ``[joints, 3]`` in the leader's order.
        partner_direction: the horizontal direction from the leader to the follower, ``[3]`` in the
            leader's world, of any length.
        rotations: whether the answer has joint rotations beside the positions, for engines
            (:class:`duet_motion.JointRotations`). Not with the unit ``"sbu-normalised"``.
        up: the true vertical of the leader's world, ``[3]``, of any length but 0, for motion from a
            tilted camera: less than 45 degrees from ``leader.up_axis``. The follower is returned
            tilted like the leader. None: ``leader.up_axis``.
        priority: ``"interactive"``, or ``"bulk"``, which yields to interactive calls.
        chunk_frames: frames per chunk of the reply. None: the server's default.
        request_id: identifies the call in the server's log: 1 to 128 printable ASCII characters
            without spaces. Empty: the server creates one.
        timeout: seconds for the whole call, including all its attempts. None: the client's.
        candidates: how many samples a model that samples draws for each window, 1 to 16. The server
            returns the one with the best grade (``SynthesisResult.grade``). More take longer.
        constraints: where joints of the follower must be in single frames (:class:`Constraint`). The
            server moves limbs or the body there, eased over the neighbouring frames;
            ``SynthesisResult.constraint_metres`` is what remains.

    Raises:
        ValueError: an argument is invalid for every server. The message has the form
            ``field: expected ..., got ...``.
    """

    leader: Motion
    labels: Optional[Labels] = None
    keyframes: Optional[Mapping[int, Labels]] = None
    seed: Optional[int] = None
    variety: float = 1.0
    reaction: float = 1.0
    model: str = ""
    clean_up: Optional[bool] = None
    follower_start: Optional[npt.ArrayLike] = None
    partner_direction: Optional[npt.ArrayLike] = None
    rotations: bool = False
    up: Optional[npt.ArrayLike] = None
    priority: str = "interactive"
    chunk_frames: Optional[int] = None
    request_id: str = ""
    timeout: Optional[float] = None
    candidates: int = 1
    constraints: Sequence[Constraint] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.leader, Motion):
            raise ValueError(f"leader: expected a duet_motion.Motion, got {short(self.leader)}")
        check_weights(self.labels, self.keyframes)
        check_answering(self)
        if not isinstance(self.rotations, (bool, np.bool_)):
            raise ValueError(f"rotations: expected True or False, got {short(self.rotations)}")
        joints = self.leader.joint_count
        check_points("follower_start", self.follower_start, ((3,), (joints, 3)),
                      self.leader.joint_names)
        check_points("partner_direction", self.partner_direction, ((3,),))
        check_points("up", self.up, ((3,),))
        if self.priority not in PRIORITIES:
            raise ValueError(f"priority: expected one of {', '.join(PRIORITIES)}, got "
                             f"{short(self.priority)}")
        if self.chunk_frames is not None:
            check_integer("chunk_frames", self.chunk_frames, 1, 2**32 - 1)
        check_request_id(self.request_id)
        if self.timeout is not None:
            checked_number("timeout", self.timeout, above=0)
        check_constraints(self.constraints)


def check_weights(labels: Optional[Labels], keyframes: Optional[Mapping[int, Labels]]) -> None:
    """Raises ValueError if the labels or the keyframes of a request are malformed."""
    check_labels("labels", {} if labels is None else labels)
    keyframes = {} if keyframes is None else keyframes
    if not isinstance(keyframes, Mapping):
        raise ValueError("keyframes: expected labels by frame, such as {0: {'hug': 1}}, got "
                         f"{short(keyframes)}")
    for frame, weights in keyframes.items():
        check_integer("keyframes: frame", frame, 0, 2**32 - 1)
        check_labels(f"keyframes[{frame}]", weights)


def check_constraints(constraints: Sequence[Constraint]) -> None:
    """Raises ValueError unless it is a sequence of Constraint."""
    if not isinstance(constraints, (list, tuple)):
        raise ValueError("constraints: expected a list of duet_motion.Constraint, got "
                         f"{short(constraints)}")
    for index, constraint in enumerate(constraints):
        if not isinstance(constraint, Constraint):
            raise ValueError(f"constraints[{index}]: expected a duet_motion.Constraint, got "
                             f"{short(constraint)}")


def to_selector(model: str) -> model_pb2.ModelSelector:
    """Parses ``NAME``, ``NAME@VERSION`` or ``NAME:LABEL``."""
    if not isinstance(model, str):
        raise ValueError(f"model: expected a str, got {short(model)}")
    selector = model_pb2.ModelSelector()
    if "@" in model:
        selector.name, _, version = model.partition("@")
        if not version.isdecimal() or not 1 <= int(version) < 2**32:
            raise ValueError(f"model: expected a version of 1 or more after the @, got {model!r}")
        selector.version = int(version)
    elif ":" in model:
        selector.name, _, selector.version_label = model.partition(":")
        if not selector.version_label:
            raise ValueError(f"model: expected a label after the colon, got {model!r}")
    else:
        selector.name = model
    return selector


def to_proto(request: SynthesisRequest) -> synthesis_pb2.SynthesizeRequest:
    """Converts a request to its wire format."""
    leader = request.leader
    out = synthesis_pb2.SynthesizeRequest(
        model=to_selector(request.model), leader=motion_pb2.Motion(
            joint_names=leader.joint_names, frame_rate_hz=leader.frame_rate_hz,
            unit=UNITS[leader.unit], up_axis=UP_AXES[leader.up_axis], frame_count=leader.frame_count,
            positions=floats(leader.positions)),
        seed=None if request.seed is None else int(request.seed), variety=float(request.variety),
        reaction=float(request.reaction),
        candidates=int(request.candidates),
        clean_up=CLEAN_UP[None if request.clean_up is None else bool(request.clean_up)],
        reply_rotations=bool(request.rotations), priority=PRIORITIES[request.priority],
        chunk_frames=None if request.chunk_frames is None else int(request.chunk_frames))
    fill(request.labels or {}, out.label_vector)
    for frame, labels in sorted((request.keyframes or {}).items()):
        fill(labels, out.label_keyframes.add(frame=int(frame)).label_vector)
    if request.follower_start is not None:
        fill_start(request.follower_start, out.follower_start)
    if request.partner_direction is not None:
        out.partner_direction.CopyFrom(direction(request.partner_direction))
    if request.up is not None:
        out.up.CopyFrom(direction(request.up))
    for constraint in request.constraints:
        x, y, z = floats(constraint.position)
        out.constraints.add(
            joint_name=constraint.joint, frame=int(constraint.frame),
            position=motion_pb2.Point(x=x, y=y, z=z), softness=float(constraint.softness))
    return out


def fill(labels: Labels, vector: reaction_pb2.LabelVector) -> None:
    """Leaves the vector absent if there are no labels, so that the server reports them missing."""
    for interaction_class, weight in labels.items():
        vector.weights.add(interaction_class=interaction_class, weight=float(weight))


def fill_start(start: npt.ArrayLike, out: motion_pb2.FollowerStart) -> None:
    values = floats(start)
    if np.ndim(start) == 1:
        out.root_position.CopyFrom(motion_pb2.Point(x=values[0], y=values[1], z=values[2]))
    else:
        out.pose.positions.extend(values)


def direction(values: npt.ArrayLike) -> motion_pb2.Direction:
    x, y, z = floats(values)
    return motion_pb2.Direction(x=x, y=y, z=z)


def floats(values: npt.ArrayLike) -> list[float]:
    flat: list[float] = np.asarray(values, dtype=np.float32).ravel().tolist()
    return flat


def check_labels(name: str, labels: Labels) -> None:
    if not isinstance(labels, Mapping):
        raise ValueError(f"{name}: expected weights by class, such as {{'hug': 1}}, got "
                         f"{short(labels)}")
    for interaction_class, weight in labels.items():
        if not isinstance(interaction_class, str):
            raise ValueError(f"{name}: expected classes of type str, got "
                             f"{short(interaction_class)}")
        if finite_number(weight) is None:
            raise ValueError(f"{name}[{interaction_class!r}]: expected a finite number, got "
                             f"{short(weight)}")


def check_answering(request: Union[SynthesisRequest, LiveRequest]) -> None:
    """Checks the fields that say which model answers, and how."""
    if request.seed is not None:
        check_integer("seed", request.seed, 0, 2**64 - 1)
    for name, value in (("variety", request.variety), ("reaction", request.reaction)):
        if finite_number(value) is None:
            raise ValueError(f"{name}: expected a number, got {short(value)}")
    check_integer("candidates", request.candidates, 1, 16)
    to_selector(request.model)
    if request.clean_up is not None and not isinstance(request.clean_up, (bool, np.bool_)):
        raise ValueError(f"clean_up: expected True, False or None, got {short(request.clean_up)}")


def check_kind(request: object, kind: type) -> None:
    """Raises TypeError unless the request is of its class."""
    if not isinstance(request, kind):
        raise TypeError(f"request: expected a duet_motion.{kind.__name__}, got "
                        f"{type(request).__name__} {short(request)}")


def check_request_id(request_id: str) -> None:
    """Raises ValueError unless it is empty or names a call in the server's log."""
    if not isinstance(request_id, str):
        raise ValueError(f"request_id: expected a str, got {short(request_id)}")
    if request_id and not _REQUEST_ID.fullmatch(request_id):
        raise ValueError("request_id: expected 1 to 128 printable ASCII characters without spaces, "
                         f"got {short(request_id)}")


def check_integer(name: str, value: object, least: int, most: int) -> None:
    if (not isinstance(value, numbers.Integral) or isinstance(value, bool)
            or not least <= int(value) <= most):
        raise ValueError(f"{name}: expected an integer from {least} to {most}, got {short(value)}")


def short(value: object) -> str:
    """The value, shortened to one line."""
    return reprlib.repr(value)


def check_points(name: str, values: Optional[npt.ArrayLike], shapes: tuple[tuple[int, ...], ...],
                  joint_names: tuple[str, ...] = ()) -> None:
    if values is None:
        return
    array = checked_array(name, values)
    if array.shape not in shapes:
        raise ValueError(f"{name}: expected the shape {' or '.join(map(str, shapes))}, got "
                         f"{array.shape}")
    found = first_not_finite(array)
    if found is not None:
        at = f" at joint {joint_names[found[0]]!r}" if array.ndim == 2 else ""
        raise ValueError(f"{name}[{', '.join(map(str, found))}]: expected a finite float32, got "
                         f"{array[found]}{at}")
