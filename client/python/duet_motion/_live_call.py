"""A live session, independent of its transport: what to send, what to resume from, what arrived."""

from __future__ import annotations

import collections
from typing import Deque, Dict, Iterable, List, Mapping, Optional, Tuple

import grpc
import numpy as np

from duet_motion._call import Attempts, CallSettings
from duet_motion._reply import LiveRotations, check_format, end_of_stream, malformed
from duet_motion.errors import DuetError, make_error
from duet_motion.live import LiveHeader, LiveNotice, LivePart, LiveRequest, LiveSummary
from duet_motion.motion import UNITS, UP_AXES, Motion, Positions
from duet_motion.request import (CLEAN_UP, Labels, check_kind, direction, fill, fill_start, floats,
                                 to_selector)
from duet_motion.result import FrameRun
from duet_motion.retry import is_retryable
from duet_motion.v1 import live_pb2, motion_pb2, reaction_pb2

# Leader frames in one message, so that no message exceeds the server's limit.
_BLOCK_FRAMES = 32
# The server's limit for the leader frames of a start.
_START_SECONDS = 10
_NOTICES = {
    live_pb2.LIVE_NOTICE_KIND_GAP_FILLED: "gap_filled",
    live_pb2.LIVE_NOTICE_KIND_LATE: "late",
    live_pb2.LIVE_NOTICE_KIND_SKIPPED: "skipped",
    live_pb2.LIVE_NOTICE_KIND_DRAINING: "draining",
}

Keyframe = Tuple[int, Dict[str, float]]


class _Frames:
    """Consecutive frames, of which the first are forgotten."""

    def __init__(self) -> None:
        self._poses: Deque[Positions] = collections.deque()
        self.first = 0
        self.end = 0
        """The index after the last frame."""

    def extend(self, poses: Iterable[Positions]) -> None:
        self._poses.extend(poses)
        self.end = self.first + len(self._poses)

    def forget(self, before: int) -> None:
        while self._poses and self.first < before:
            self._poses.popleft()
            self.first += 1

    def values(self, first: int, end: int) -> List[float]:
        """The values of frames first to before end."""
        poses = [self._poses[frame - self.first] for frame in range(first, end)]
        return floats(np.stack(poses)) if poses else []


class LabelTrack:
    """The label vector of a session over time, as keyframes: linear between them, constant before the first and after the last."""

    def __init__(self, keyframes: Mapping[int, Labels]) -> None:
        self._keys: List[Keyframe] = sorted(
            (int(frame), {name: float(weight) for name, weight in labels.items()})
            for frame, labels in keyframes.items())

    def at(self, frame: int) -> Dict[str, float]:
        """The weights at a frame; empty without keyframes."""
        before = [key for key in self._keys if key[0] <= frame]
        after = [key for key in self._keys if key[0] > frame]
        if not before or not after:
            key = before[-1] if before else after[0] if after else (0, {})
            return dict(key[1])
        (first, old), (last, new) = before[-1], after[0]
        share = (frame - first) / (last - first)
        return {name: old.get(name, 0.0) + (new.get(name, 0.0) - old.get(name, 0.0)) * share
                for name in {**old, **new}}

    def change(self, frame: int, labels: Labels, ease_frames: int) -> None:
        """Changes the weights linearly from those at ``frame`` to ``labels`` within
        ``ease_frames``, and drops the keyframes after ``frame``."""
        last = frame if ease_frames else frame - 1  # the last frame with the old weights
        old = self.at(last)
        self._keys = [key for key in self._keys if key[0] < last]
        if last >= 0 and old:
            self._keys.append((last, old))
        self._keys.append((frame + ease_frames,
                           {name: float(weight) for name, weight in labels.items()}))

    def since(self, frame: int) -> List[Keyframe]:
        """Forgets the keyframes that do not apply at ``frame`` or later, and returns the others."""
        past = [at for at, _ in self._keys if at <= frame]
        self._keys = [key for key in self._keys if not past or key[0] >= past[-1]]
        return list(self._keys)


class LiveReply:
    """Checks the responses of one stream message by message."""

    def __init__(self, leader: Motion, first_frame: int) -> None:
        self._leader = leader
        self.next_frame = first_frame
        """Index of the follower's next frame."""
        self._first_frame = first_frame
        self.header: Optional[live_pb2.LiveHeader] = None
        self.summary: Optional[live_pb2.LiveSummary] = None

    @property
    def frame_count(self) -> int:
        """Number of frames of this stream so far."""
        return self.next_frame - self._first_frame

    def check_order(self, kind: Optional[str]) -> None:
        """Raises MalformedReplyError if a payload of this kind must not come now."""
        if kind is None:
            raise malformed("a message without a payload")
        if self.summary is not None:
            raise malformed("a message after the summary")
        if (self.header is None) != (kind == "header"):
            raise malformed("a second header" if kind == "header" else f"{kind} before the header")

    def accept_header(self, header: live_pb2.LiveHeader) -> None:
        check_format(header, self._leader)
        if header.first_frame != self._first_frame:
            raise malformed(f"header.first_frame: expected {self._first_frame}, got "
                            f"{header.first_frame}")
        if header.history_frames < 1:
            raise malformed("header.history_frames: expected 1 or more, got 0")
        self.header = header

    def accept_frames(self, frames: live_pb2.FollowerFrames, sent: int) -> Positions:
        """Returns the final frames. ``sent``: number of leader frames sent so far."""
        if frames.first_frame != self.next_frame:
            raise malformed(f"frames.first_frame: expected {self.next_frame}, got "
                            f"{frames.first_frame}")
        left = sent - self.next_frame
        if not 1 <= frames.frame_count <= left:
            raise malformed(f"frames.frame_count: expected 1 to {left}, got {frames.frame_count}")
        if frames.leader_frame >= sent:
            raise malformed(f"frames.leader_frame: expected less than the {sent} frames sent, got "
                            f"{frames.leader_frame}")
        positions = self.poses("frames.positions", frames.positions)
        if len(positions) != frames.frame_count:
            raise malformed(f"frames.positions: expected {frames.frame_count} frames, got "
                            f"{len(positions)}")
        self.next_frame += frames.frame_count
        return positions

    def poses(self, field: str, values: object) -> Positions:
        """Values as ``[frames, joints, 3]``; raises MalformedReplyError."""
        flat = np.array(values, dtype=np.float32)
        if flat.size % (self._leader.joint_count * 3):
            raise malformed(f"{field}: expected {self._leader.joint_count} joints of 3 values for "
                            f"each frame, got {flat.size} values")
        if not np.isfinite(flat).all():
            raise malformed(f"{field}: expected finite values, got others")
        return flat.reshape(-1, self._leader.joint_count, 3)

    def accept_summary(self, summary: live_pb2.LiveSummary) -> None:
        if summary.frame_count != self.frame_count:
            raise malformed(f"summary.frame_count: expected {self.frame_count}, got "
                            f"{summary.frame_count}")
        self.summary = summary

    def end(self, error: Optional[DuetError]) -> Optional[DuetError]:
        """Handles the end of the stream; returns None if the reply is complete, else its error."""
        return end_of_stream(error, self.summary is not None, self.header is not None,
                             f"the session broke off before frame {self.next_frame}")


class LiveCall:
    """The state of a session over all its streams.

    The last ``LiveHeader.history_frames`` frames of both motions are kept to resume, and the leader
    frames that are not answered.
    """

    def __init__(self, request: LiveRequest, settings: CallSettings) -> None:
        check_kind(request, LiveRequest)
        self.request = request
        self.motion = request.leader()
        self._settings = settings
        self.attempts = Attempts(settings, request_id=request.request_id)
        self._labels = LabelTrack(request.keyframes or {0: request.labels or {}})
        self._leader, self._follower = _Frames(), _Frames()
        self._rotations = LiveRotations(bool(request.rotations), self.motion.joint_count)
        # Frame 0 of both motions: a resumed session makes its rig from them.
        self._rig_poses: List[Optional[Positions]] = [None, None]
        self._captures: Deque[float] = collections.deque()  # of the leader frames kept
        self._outbox: Deque[live_pb2.SynthesizeLiveRequest] = collections.deque()
        self._reply = LiveReply(self.motion, 0)
        self._has_stream = False
        self.header: Optional[LiveHeader] = None
        self.summary: Optional[LiveSummary] = None
        self.is_finished = False
        self.is_draining = False
        self._progressed = False
        self._totals = {kind: 0 for kind in _NOTICES.values()}
        self._resumes = 0

    @property
    def sent(self) -> int:
        """Number of leader frames so far."""
        return self._leader.end

    @property
    def unanswered(self) -> int:
        """Number of leader frames whose follower frames have not arrived."""
        return self._leader.end - self._follower.end

    @property
    def is_owed(self) -> bool:
        """Whether the server must send something now."""
        return (self._reply.header is None or self.is_finished
                or self.unanswered > self.request.delay)

    def now(self) -> float:
        """Seconds on the session's clock."""
        return self._settings.environment.now()

    def add(self, frames: Positions, capture_seconds: float) -> None:
        """Adds leader frames ``[frames, joints, 3]``, the last of them captured at
        ``capture_seconds``."""
        first = self._leader.end
        if first == 0:
            self._rig_poses[0] = frames[0]
        self._leader.extend(frames)
        last = len(frames) - 1
        self._captures.extend(capture_seconds - (last - index) / self.motion.frame_rate_hz
                              for index in range(len(frames)))
        if self._has_stream:
            self._send_frames(first)

    def change_labels(self, labels: Labels, ease_frames: int) -> int:
        """Changes the labels from the first frame that is not final on; returns that frame."""
        frame = max(self._leader.end - self.request.delay, 0)
        self._labels.change(frame, labels, ease_frames)
        self._labels.since(self._history_start())
        if self._has_stream:
            message = live_pb2.LabelChange(frame=frame, ease_frames=ease_frames)
            fill(labels, message.label_vector)
            self._outbox.append(live_pb2.SynthesizeLiveRequest(label_change=message))
        return frame

    def begin(self) -> None:
        """Starts a stream."""
        self.attempts.begin()
        self._progressed = self.is_draining = False
        end = self._resumed_from()
        self._reply = LiveReply(self.motion, end)
        self._rotations.begin()
        start = self._start(end)
        self._outbox.clear()
        self._outbox.append(live_pb2.SynthesizeLiveRequest(start=start))
        self._has_stream = True
        self._send_frames(self._start_end(end))

    def next_message(self) -> Optional[live_pb2.SynthesizeLiveRequest]:
        """The next message of this stream; None if there is none yet."""
        return self._outbox.popleft() if self._outbox else None

    def accept(self, response: live_pb2.SynthesizeLiveResponse) -> Optional[LivePart]:
        """Accepts a message and returns its frames that the caller does not have yet, if any."""
        kind = response.WhichOneof("payload")
        self._reply.check_order(kind)
        if kind == "header":
            self._accept_header(response.header)
        elif kind == "frames":
            return self._accept_frames(response.frames)
        elif kind == "notice":
            self._accept_notice(response.notice)
        else:
            self._accept_summary(response.summary)
        return None

    def wait_after(self, error: Optional[DuetError]) -> Optional[float]:
        """Handles the end of a stream, with ``error`` or without one. Returns None if the session
        is complete, else the seconds until the next attempt. Raises the error of a failed call."""
        self._has_stream = False
        answered = self._reply.header is not None
        ended = self._reply.end(error)
        if ended is None:
            return None
        if self._follower.end and ended.code is grpc.StatusCode.NOT_FOUND:
            assert self.header is not None
            raise make_error(
                grpc.StatusCode.ABORTED,
                f"the session broke off after {self._follower.end} frames and cannot be resumed: "
                f"{self.header.model_name}@{self.header.model_version} is no longer served")
        if self._progressed and is_retryable(ended):
            # The interruption begins now; the first attempt to resume follows at once.
            self.attempts = Attempts(self._settings, request_id=self.request.request_id)
            return 0.0
        return self.attempts.wait_after(ended, answered)

    def _resumed_from(self) -> int:
        """The follower's first frame in a new stream. Frames that were final only because the
        leader had ended are synthesised again."""
        return max(min(self._follower.end, self._leader.end - self.request.delay), 0)

    def _history_start(self) -> int:
        kept = self.header.history_frames if self.header else self._leader.end
        return max(self._resumed_from() - kept, 0)

    def _start_end(self, end: int) -> int:
        """The index after the last leader frame in a start. Those that have no answer belong to it:
        the server evaluates all of them, whereas it skips evaluations for frames that queue up
        later."""
        if not end:
            return 0
        most = self._history_start() + int(_START_SECONDS * self.motion.frame_rate_hz)
        return max(min(most, self._leader.end), end + self.request.delay)

    def _seed(self) -> Optional[int]:
        """A resumed session keeps the seed that the server chose."""
        if self.request.seed is not None:
            return int(self.request.seed)
        return None if self.header is None else self.header.seed

    def _start(self, end: int) -> live_pb2.LiveStart:
        request, header = self.request, self.header
        first = self._history_start()
        start = live_pb2.LiveStart(
            model=to_selector(request.model), leader=motion_pb2.Motion(
                joint_names=self.motion.joint_names, frame_rate_hz=self.motion.frame_rate_hz,
                unit=UNITS[self.motion.unit], up_axis=UP_AXES[self.motion.up_axis]),
            seed=self._seed(), variety=float(request.variety),
            reaction=float(request.reaction),
            candidates=int(request.candidates),
            clean_up=CLEAN_UP[None if request.clean_up is None else bool(request.clean_up)],
            delay_frames=int(request.delay), plan_frames=int(request.plan),
            reply_rotations=bool(request.rotations))
        self._fill_labels(start, first)
        if request.partner_direction is not None:
            start.partner_direction.CopyFrom(direction(request.partner_direction))
        if request.up is not None:
            start.up.CopyFrom(direction(request.up))
        if not end:
            if request.follower_start is not None:
                fill_start(request.follower_start, start.follower_start)
            return start
        assert header is not None
        # One follower must not mix the answers of two versions.
        start.model.Clear()
        start.model.name, start.model.version = header.model_name, header.model_version
        leader_end = self._start_end(end)
        start.leader.frame_count = leader_end - first
        start.leader.positions.extend(self._leader.values(first, leader_end))
        start.history.first_frame = first
        start.history.follower_frame_count = end - first
        start.history.follower_positions.extend(self._follower.values(first, end))
        leader, follower = self._rig_poses
        if request.rotations and leader is not None and follower is not None:
            start.history.rig_leader_positions.extend(floats(leader))
            start.history.rig_follower_positions.extend(floats(follower))
        return start

    def _fill_labels(self, start: live_pb2.LiveStart, first: int) -> None:
        keys = self._labels.since(first)
        if len(keys) == 1:
            fill(keys[0][1], start.label_vector)
            return
        for frame, labels in keys:
            fill(labels, start.label_keyframes.add(frame=frame).label_vector)

    def _send_frames(self, first: int) -> None:
        for begin in range(first, self._leader.end, _BLOCK_FRAMES):
            end = min(begin + _BLOCK_FRAMES, self._leader.end)
            self._outbox.append(live_pb2.SynthesizeLiveRequest(frames=live_pb2.LeaderFrames(
                first_frame=begin, frame_count=end - begin,
                positions=self._leader.values(begin, end), capture_seconds=self._capture(end - 1))))

    def _capture(self, frame: int) -> float:
        """When a leader frame was captured; frames that are not kept are as old as the oldest."""
        return self._captures[max(frame - self._leader.first, 0)]

    def _accept_header(self, header: live_pb2.LiveHeader) -> None:
        self._reply.accept_header(header)
        if self.header is not None:
            self._resumes += 1
            self._notify(LiveNotice("resumed"))
            return
        self.header = LiveHeader(
            model_name=header.model_name, model_version=header.model_version,
            interaction_classes=tuple(header.interaction_classes), request_id=header.request_id,
            seed=header.seed, variety=header.variety, candidates=max(1, header.candidates),
            delay=header.delay_frames, cleaned_up=header.clean_up == reaction_pb2.CLEAN_UP_ON,
            history_frames=header.history_frames)

    def _accept_frames(self, frames: live_pb2.FollowerFrames) -> Optional[LivePart]:
        positions = self._reply.accept_frames(frames, self._leader.end)
        plan = self._reply.poses("frames.plan_positions", frames.plan_positions)
        known = max(self._follower.end - frames.first_frame, 0)
        try:
            rotations = self._rotations.read(frames, known)
        except ValueError as error:
            raise malformed(str(error)) from error
        new = positions[known:]
        if not len(new):
            return None
        self._progressed = True
        captured = self._capture(frames.leader_frame)
        first = self._follower.end
        if first == 0:
            self._rig_poses[1] = new[0]
        self._follower.extend(new)
        self._forget()
        return LivePart(first, new, plan, frames.leader_frame, captured,
                        self.now() - captured, frames.server_seconds, rotations)

    def _forget(self) -> None:
        first = self._history_start()
        self._follower.forget(first)
        before = self._leader.first
        self._leader.forget(first)
        for _ in range(self._leader.first - before):
            self._captures.popleft()

    def _accept_notice(self, notice: live_pb2.LiveNotice) -> None:
        kind = _NOTICES.get(notice.kind)
        if kind is None:
            return  # of a later version of the API
        self.is_draining = self.is_draining or kind == "draining"
        self._totals[kind] += notice.frames.frame_count
        run = FrameRun(notice.frames.first_frame, notice.frames.frame_count)
        self._notify(LiveNotice(kind, None if kind == "draining" else run))

    def _notify(self, notice: LiveNotice) -> None:
        if self.request.on_notice is not None:
            self.request.on_notice(notice)

    def _accept_summary(self, summary: live_pb2.LiveSummary) -> None:
        self._reply.accept_summary(summary)
        self.summary = LiveSummary(
            frame_count=self._follower.end, gap_frames=self._totals["gap_filled"],
            late_frames=self._totals["late"], skipped_frames=self._totals["skipped"],
            resume_count=self._resumes, window_count=summary.window_count,
            queue_seconds=summary.queue_seconds, compute_seconds=summary.compute_seconds)
