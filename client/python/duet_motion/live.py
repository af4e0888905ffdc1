"""Live sessions: the server answers a leader while it still moves (docs/live.md)."""

from __future__ import annotations

import dataclasses
from typing import Callable, Mapping, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from duet_motion.motion import Motion, Positions
from duet_motion.request import (Labels, check_answering, check_integer, check_points,
                                 check_request_id, check_weights, short)
from duet_motion.result import FrameRun, JointRotations

MAX_DELAY, MAX_PLAN = 10, 30


@dataclasses.dataclass(frozen=True)
class LiveNotice:
    """An event of a live session."""

    kind: str
    """``"gap_filled"``: leader frames were missing and were interpolated. ``"late"``: leader frames
    that the server already had were dropped. ``"skipped"``: leader frames arrived faster than the
    server answers, and these frames are from an older plan. ``"draining"``: the server is shutting
    down; the session resumes elsewhere. ``"resumed"``: the session goes on after an interruption."""
    frames: Optional[FrameRun] = None
    """The frames concerned; None for ``"draining"`` and ``"resumed"``."""


@dataclasses.dataclass(frozen=True, eq=False)
class LivePart:
    """Consecutive final frames of the follower."""

    first_frame: int
    """Index of the first of these frames, counted from the leader's first. Each part begins where
    the part before it ends."""
    positions: Positions
    """``[frames, joints, 3]`` in the leader's joints, unit and world."""
    plan: Positions
    """``[frames, joints, 3]``: what the server expects after these frames. Provisional: each part
    replaces the plan of the part before it. No frames without ``plan``."""
    leader_frame: int
    """The newest leader frame that the server had."""
    capture_seconds: float
    """When that leader frame was captured (:meth:`duet_motion.aio.LiveSession.send`)."""
    latency: float
    """Seconds from that capture to the arrival of this part, if ``send`` was given no other
    clock."""
    server_seconds: float
    """Seconds from the arrival of that leader frame at the server to the server's answer."""
    rotations: Optional[JointRotations] = None
    """The joint rotations of ``positions`` (docs/rotations.md); None without ``rotations``. The rig
    is the same in every part."""


@dataclasses.dataclass(frozen=True)
class LiveHeader:
    """The settings of a live session, from its first stream."""

    model_name: str
    model_version: int
    interaction_classes: Tuple[str, ...]
    """Every class of the model."""
    request_id: str
    """Identifies the call in the server's log."""
    seed: int
    variety: float
    candidates: int
    delay: int
    cleaned_up: bool
    """Whether the server corrects the follower."""
    history_frames: int
    """Number of last frames of both motions that the session keeps to resume."""


@dataclasses.dataclass(frozen=True)
class LiveSummary:
    """The end of a live session."""

    frame_count: int
    """Number of frames of the follower, over all streams."""
    gap_frames: int
    """Number of leader frames that were interpolated, over all streams."""
    late_frames: int
    """Number of leader frames that were dropped, over all streams."""
    skipped_frames: int
    """Number of frames that were answered from an older plan, over all streams."""
    resume_count: int
    """How many times the session was resumed."""
    window_count: int
    """Number of windows that the network computed for the last stream."""
    queue_seconds: float
    """Time of these windows in the server's queue."""
    compute_seconds: float
    """Time of these windows in the network."""


@dataclasses.dataclass(frozen=True, eq=False)
class LiveRequest:
    """A request for a follower of a leader that still moves.

    Args:
        joint_names: names of the leader's joints, in the order of its positions: those of the model
            (:meth:`duet_motion.aio.Client.get_model`), in any order.
        frame_rate_hz: frames per second of both motions.
        labels: weights by interaction class from the first frame on, from -2 to 2, such as
            ``{"hug": 1, "push": 0.5}``: 1 requests a class, 0 is neutral, -1 avoids it.
        keyframes: instead of ``labels``, weights by frame number: interpolated linearly, constant
            before the first and after the last.
        delay: how many later leader frames the server waits for before it answers a frame, 0 to
            10. 0 answers at once; a few frames give a better reaction.
        plan: number of provisional frames to send with each answer, 0 to 30.
        seed: selects an answer of a model that samples, 0 to 2^64 - 1. None: a typical one of the model;
            ``LiveHeader.seed`` has it.
        variety: how much answers differ between seeds, 0 to 2.
        reaction: how much the leader's motion moves the follower, 0 to 2.
        model: ``"sbu"``, ``"sbu@3"`` for a version, ``"sbu:stable"`` for a version label; empty:
            the server's default.
        clean_up: whether the server corrects the follower. None: the server's default.
        follower_start: the follower's position in the first frame, in the leader's world and unit:
            its root joint ``[3]``, or every joint ``[joints, 3]`` in the leader's order.
        partner_direction: the horizontal direction from the leader to the follower, ``[3]``.
        up: the true vertical of the leader's world, ``[3]``, for motion from a tilted camera.
        candidates: how many samples a model that samples draws for each window, 1 to 16.
        unit: ``"metres"``, ``"millimetres"`` or ``"sbu-normalised"``.
        up_axis: ``"y-up"``, ``"z-up"`` or ``"y-down"``.
        rotations: whether the final frames have joint rotations beside the positions, for engines
            (docs/rotations.md).
        request_id: identifies the call in the server's log: 1 to 128 printable ASCII characters
            without spaces. Empty: the server creates one.
        on_notice: called with each :class:`duet_motion.LiveNotice`. It must not block.

    Raises:
        ValueError: an argument is invalid for every server. The message has the form
            ``field: expected ..., got ...``.
    """

    joint_names: Sequence[str]
    frame_rate_hz: float
    labels: Optional[Labels] = None
    keyframes: Optional[Mapping[int, Labels]] = None
    delay: int = 0
    plan: int = 0
    seed: Optional[int] = None
    variety: float = 1.0
    reaction: float = 1.0
    model: str = ""
    clean_up: Optional[bool] = None
    follower_start: Optional[npt.ArrayLike] = None
    partner_direction: Optional[npt.ArrayLike] = None
    up: Optional[npt.ArrayLike] = None
    candidates: int = 1
    unit: str = "metres"
    up_axis: str = "y-up"
    rotations: bool = False
    request_id: str = ""
    on_notice: Optional[Callable[[LiveNotice], None]] = None

    def __post_init__(self) -> None:
        names = self.leader().joint_names
        object.__setattr__(self, "joint_names", names)
        check_weights(self.labels, self.keyframes)
        check_integer("delay", self.delay, 0, MAX_DELAY)
        check_integer("plan", self.plan, 0, MAX_PLAN)
        check_answering(self)
        check_points("follower_start", self.follower_start, ((3,), (len(names), 3)), names)
        check_points("partner_direction", self.partner_direction, ((3,),))
        check_points("up", self.up, ((3,),))
        if not isinstance(self.rotations, (bool, np.bool_)):
            raise ValueError(f"rotations: expected True or False, got {short(self.rotations)}")
        check_request_id(self.request_id)

    def leader(self) -> Motion:
        """A leader without frames, in the session's joints, rate, unit and axis."""
        if isinstance(self.joint_names, str):
            raise ValueError("joint_names: expected a sequence of names, got "
                             f"{short(self.joint_names)}")
        names = tuple(self.joint_names)
        return Motion(np.zeros((0, len(names), 3), np.float32), names, self.frame_rate_hz,
                      self.unit, self.up_axis)
