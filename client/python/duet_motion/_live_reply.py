"""Checks the responses of a live session message by message."""

from __future__ import annotations

from typing import Optional

import numpy as np

from duet_motion._reply import check_format, end_of_stream, malformed
from duet_motion.errors import DuetError
from duet_motion.motion import Motion, Positions
from duet_motion.v1 import live_pb2


class LiveReply:
    """The responses of one stream."""

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
