"""A live session over asyncio."""

from __future__ import annotations

import asyncio
import collections
import contextlib
import math
import threading
from types import TracebackType
from typing import Any, AsyncIterator, Deque, Optional, Type

import grpc
import grpc.aio
import numpy as np
import numpy.typing as npt

from duet_motion import _channel
from duet_motion._live_call import LiveCall
from duet_motion.errors import (CancelledError, DuetError, UnavailableError, from_rpc_error,
                                make_error)
from duet_motion.live import LiveHeader, LivePart, LiveSummary
from duet_motion.motion import Positions, finite_number
from duet_motion.request import Labels, check_labels, short
from duet_motion.v1 import live_pb2, synthesis_pb2_grpc

# Frames that may be unanswered or not taken, before `send` waits.
_MOST_AHEAD_SECONDS = 10
MAX_EASE_SECONDS = 10


class LiveSession(AsyncIterator[LivePart]):
    """A follower that answers a leader while it still moves (docs/live.md).

    >>> async with client.live(joint_names, 30, {"hug": 1}) as session:
    ...     feeding = asyncio.create_task(feed(session))   # send() for each frame, then finish()
    ...     async for part in session:
    ...         show(part.first_frame, part.positions, part.plan)
    >>> session.summary.frame_count

    Iterating yields every final frame once and in order. If the stream breaks or the server shuts
    down, the session resumes on a server that can be reached, for the client's ``wait`` seconds,
    and goes on with the next frame; then iterating and :meth:`send` raise
    :class:`duet_motion.DuetError`. Iterate in one task and send in another: :meth:`send` waits if
    the frames are not taken. Leaving ``async with`` ends the session.
    """

    def __init__(self, stub: synthesis_pb2_grpc.MotionSynthesisStub, channel: grpc.aio.Channel,
                 closed: threading.Event, call: LiveCall, stall_seconds: float) -> None:
        self._stub, self._channel, self._closed, self._call = stub, channel, closed, call
        self._stall_seconds = stall_seconds
        self._parts: Deque[LivePart] = collections.deque()
        self._untaken = 0
        self._most_ahead = math.ceil(_MOST_AHEAD_SECONDS * call.motion.frame_rate_hz)
        self._changed = asyncio.Event()  # replaced at every change; see _notify
        self._task: Optional[asyncio.Task[None]] = None
        self._error: Optional[Exception] = None
        self._ended = False
        self._leaving = False

    @property
    def header(self) -> Optional[LiveHeader]:
        """The settings that the server uses; None until it has answered."""
        return self._call.header

    @property
    def summary(self) -> Optional[LiveSummary]:
        """The end of the session; None until iterating has ended."""
        return self._call.summary

    @property
    def frames_sent(self) -> int:
        """Number of leader frames so far; the next one has this index."""
        return self._call.sent

    async def __aenter__(self) -> LiveSession:
        _channel.check_open(self._closed)
        self._task = asyncio.ensure_future(self._run())
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        traceback: Optional[TracebackType]) -> None:
        self._leaving = True
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._task
        self._end(None)

    def __aiter__(self) -> LiveSession:
        return self

    async def __anext__(self) -> LivePart:
        while not self._parts:
            if self._ended:
                self._raise_error()
                raise StopAsyncIteration
            await self._changed.wait()
        part = self._parts.popleft()
        self._untaken -= len(part.positions)
        self._notify()
        return part

    async def send(self, frames: npt.ArrayLike, *,
                   capture_seconds: Optional[float] = None) -> None:
        """Sends the leader's next frames. While the server cannot be reached, the session keeps
        them. Waits while 10 seconds of frames are unanswered or have not been taken.

        Args:
            frames: positions ``[joints, 3]`` of one frame or ``[frames, joints, 3]`` of several, in
                the session's joints, unit and world. Frames count from 0 without gaps.
            capture_seconds: when the last of these frames was captured, on the clock of
                ``time.monotonic()``. None: now. ``LivePart.capture_seconds`` returns it.

        Raises:
            ValueError: the frames are malformed.
            DuetError: the session has failed or ended.
        """
        array = np.asarray(frames)
        positions = self._call.motion.with_positions(
            array[np.newaxis] if array.ndim == 2 else array).positions
        if capture_seconds is not None and finite_number(capture_seconds) is None:
            raise ValueError("capture_seconds: expected a finite number, got "
                             f"{short(capture_seconds)}")
        captured = self._call.now() if capture_seconds is None else float(capture_seconds)
        for begin in range(0, len(positions), self._most_ahead):
            block = positions[begin:begin + self._most_ahead]
            later = (len(positions) - begin - len(block)) / self._call.motion.frame_rate_hz
            await self._send(block, captured - later)

    async def change_labels(self, labels: Labels, *, ease_seconds: float = 0.0) -> int:
        """Changes the weights from the first frame that is not final on, and drops later keyframes.

        Args:
            labels: weights by interaction class, at least one; classes without a weight have 0.
            ease_seconds: time until the new weights apply in full, 0 to 10.

        Returns:
            The frame from which on the weights change.

        Raises:
            ValueError: an argument is invalid for every server.
            DuetError: the session has failed or ended.
        """
        check_labels("labels", labels)
        if not labels:
            raise ValueError("labels: expected at least one weight, got none")
        ease = finite_number(ease_seconds)
        if ease is None or not 0 <= ease <= MAX_EASE_SECONDS:
            raise ValueError(f"ease_seconds: expected 0 to {MAX_EASE_SECONDS}, got "
                             f"{short(ease_seconds)}")
        await self._wait_for_room()
        frame = self._call.change_labels(labels, round(ease * self._call.motion.frame_rate_hz))
        self._notify()
        return frame

    async def finish(self) -> None:
        """Ends the leader. The frames that are due still arrive, then iterating ends.

        Raises:
            DuetError: the session has failed.
        """
        self._check_begun()
        self._raise_error()
        self._call.is_finished = True
        self._notify()

    async def _send(self, positions: Positions, captured: float) -> None:
        await self._wait_for_room()
        self._call.add(positions, captured)
        self._notify()

    async def _wait_for_room(self) -> None:
        self._check_begun()
        while True:
            self._raise_error()
            if self._ended or self._call.is_finished:
                raise CancelledError(grpc.StatusCode.CANCELLED, "the session has ended")
            if self._call.unanswered + self._untaken < self._most_ahead:
                return
            await self._changed.wait()

    def _check_begun(self) -> None:
        if self._task is None:
            raise RuntimeError("session: expected `async with client.live(...) as session`, got a "
                               "call outside of it")

    def _raise_error(self) -> None:
        if self._error is not None:
            raise self._error

    def _notify(self) -> None:
        """Wakes every task that waits for a change."""
        self._changed.set()
        self._changed = asyncio.Event()

    def _end(self, error: Optional[Exception]) -> None:
        self._error = self._error or error
        self._ended = True
        self._notify()

    async def _run(self) -> None:
        wait: Optional[float] = 0.0
        try:
            while wait is not None:
                if wait:
                    self._channel.get_state(try_to_connect=True)
                    await asyncio.sleep(wait)
                _channel.check_open(self._closed)
                error = await self._stream()
                _channel.check_open(self._closed)
                wait = self._call.wait_after(error)
            self._end(None)
        except Exception as failed:  # such as one of on_notice
            self._end(failed)

    async def _stream(self) -> Optional[DuetError]:
        """Runs one stream to its end and returns its error, if any."""
        self._call.begin()
        stream = self._stub.SynthesizeLive(metadata=self._call.attempts.metadata)
        writing = asyncio.ensure_future(self._write(stream))
        try:
            while True:
                response = await self._read(stream)
                if response is grpc.aio.EOF:
                    return None
                part = self._call.accept(response)
                if part is not None:
                    self._parts.append(part)
                    self._untaken += len(part.positions)
                    self._notify()
                if self._call.is_draining:
                    return make_error(grpc.StatusCode.UNAVAILABLE, "the server is shutting down")
        except grpc.RpcError as error:
            return from_rpc_error(error)
        except UnavailableError as stalled:
            return stalled
        except asyncio.CancelledError:
            # gRPC raises it for a stream that the server cancelled, and asyncio for a task.
            if self._leaving or not stream.done():
                raise
            return make_error(grpc.StatusCode.CANCELLED, "the server cancelled the stream")
        finally:
            writing.cancel()
            stream.cancel()

    async def _read(self, stream: Any) -> Any:
        """The next message. Gives up if the server owes frames and sends nothing."""
        reading = asyncio.ensure_future(stream.read())
        try:
            while True:
                done, _ = await asyncio.wait({reading}, timeout=self._stall_seconds)
                if done:
                    return reading.result()
                if self._call.is_owed:
                    raise make_error(grpc.StatusCode.UNAVAILABLE,
                                     f"the server sent nothing for {self._stall_seconds:g} s")
        finally:
            reading.cancel()

    async def _write(self, stream: Any) -> None:
        """Writes messages until the stream ends; its status has the reason of an error."""
        with contextlib.suppress(grpc.RpcError, asyncio.InvalidStateError):
            # gRPC ignores the cancellation of a write if the stream has ended with OK. Later messages
            # are those of the next stream.
            while not stream.done():
                changed = self._changed
                message: Optional[live_pb2.SynthesizeLiveRequest] = self._call.next_message()
                if message is not None:
                    await stream.write(message)
                elif self._call.is_finished:
                    await stream.done_writing()
                    return
                else:
                    await changed.wait()
