"""A call, independent of its transport: attempts, deadline, pinned model, the reply so far."""

from __future__ import annotations

import dataclasses
import random
import time
from typing import Callable, List, Optional, Tuple

import grpc

from duet_motion._reply import ReplyAssembler
from duet_motion.errors import DuetError, make_error
from duet_motion.motion import checked_number
from duet_motion.request import SynthesisRequest, check_kind, to_proto
from duet_motion.result import FollowerChunk, SynthesisResult
from duet_motion.retry import (RetryOptions, describe_unreachable, has_no_server, is_retryable,
                               is_unreachable, retry_wait)
from duet_motion.v1 import synthesis_pb2

Metadata = Tuple[Tuple[str, str], ...]


@dataclasses.dataclass(frozen=True)
class Environment:
    """The clock and the random source; tests replace them."""

    now: Callable[[], float] = time.monotonic
    """Seconds."""
    uniform: Callable[[], float] = random.random
    """In [0, 1)."""


@dataclasses.dataclass(frozen=True)
class CallSettings:
    """Settings of every call of a client."""

    timeout: float
    """Seconds for a whole call, including all its attempts."""
    retry: RetryOptions
    metadata: Metadata = ()
    environment: Environment = Environment()
    wait: float = 5.0
    """Seconds to retry a server that cannot be reached."""
    address: str = ""
    """The server's address, for error messages."""


class Attempts:
    """Counts the attempts of a call and decides whether to make another one."""

    def __init__(self, settings: CallSettings, timeout: Optional[float] = None,
                 request_id: str = "") -> None:
        self._settings = settings
        self.timeout = settings.timeout if timeout is None else checked_number(
            "timeout", timeout, above=0)
        self.start = settings.environment.now()
        self.metadata: Metadata = settings.metadata
        if request_id:
            self.metadata += (("x-request-id", request_id),)
        self.made = 0
        # When the first of the latest consecutive attempts without a server ended.
        self._away_since: Optional[float] = None

    def seconds_left(self) -> float:
        """Until the deadline; at least 0.001."""
        return max(self.start + self.timeout - self._settings.environment.now(), 0.001)

    def begin(self) -> float:
        """Counts an attempt and returns its timeout in seconds."""
        self.made += 1
        return self.seconds_left()

    def wait_after(self, error: DuetError, answered: bool = False) -> float:
        """Returns the seconds until the next attempt, or raises the error if there is none.

        ``answered``: the server sent part of a reply before the attempt failed.
        """
        options = self._settings.retry
        unreachable = not answered and is_unreachable(error)
        if not answered and has_no_server(error):
            error = error.with_message(describe_unreachable(self._settings.address, error.message))
        is_last = options.max_attempts is not None and self.made >= options.max_attempts
        if is_last or not is_retryable(error):
            raise self._after_attempts(error, "")
        environment = self._settings.environment
        now, wait = environment.now(), retry_wait(options, self.made, error, environment.uniform())
        if not unreachable:
            self._away_since = None
        else:
            self._away_since = now if self._away_since is None else self._away_since
            left = self._away_since + self._settings.wait - now
            # The last attempt starts when the wait ends, not up to a backoff earlier.
            wait = min(wait, left)
            if left <= 0 or now + wait >= self.start + self.timeout:
                raise self._no_server(error)
        if now + wait >= self.start + self.timeout:
            raise self._after_attempts(error, ", the deadline leaves no time for another")
        if options.on_wait is not None:
            options.on_wait(error, wait)
        return wait

    def elapsed(self) -> float:
        return self._settings.environment.now() - self.start

    def _no_server(self, error: DuetError) -> DuetError:
        return error.with_message(
            f"{error.message} ({self._count()} in {self.elapsed():.1f} s); start it with "
            "duet-server, name another one (DUET_SERVER, or duet_motion.Client(ADDRESS)), or wait "
            "longer (wait=SECONDS)")

    def _after_attempts(self, error: DuetError, reason: str) -> DuetError:
        if self.made == 1 and not reason:
            return error
        return error.with_message(f"{error.message} (after {self._count()}{reason})")

    def _count(self) -> str:
        return f"{self.made} attempt{'' if self.made == 1 else 's'}"


class SynthesisCall:
    """One Synthesize call: its request and the reply so far."""

    def __init__(self, request: SynthesisRequest, settings: CallSettings) -> None:
        check_kind(request, SynthesisRequest)
        self.attempts = Attempts(settings, request.timeout, request.request_id)
        self._wire = to_proto(request)
        self._reply = ReplyAssembler(request.leader, bool(request.rotations),
                                     len(request.constraints))
        self._first_chunk: List[float] = []
        self._resumed_after = 0

    def begin(self) -> Tuple[synthesis_pb2.SynthesizeRequest, float]:
        """Starts an attempt; returns its request and its timeout in seconds."""
        seconds = self.attempts.begin()
        self._resumed_after = self._reply.handed_out
        if self._resumed_after and self._reply.header is not None:
            # One follower must not mix the answers of two versions.
            self._wire.model.name = self._reply.header.model_name
            self._wire.model.version = self._reply.header.model_version
        self._reply.start_stream()
        return self._wire, seconds

    def accept(self, response: synthesis_pb2.SynthesizeResponse) -> Optional[FollowerChunk]:
        """Accepts a message and returns its frames that the caller does not have yet, if any."""
        chunk = self._reply.accept(response)
        if self._reply.received and not self._first_chunk:
            self._first_chunk.append(self.attempts.elapsed())
        return chunk

    def wait_after(self, error: Optional[DuetError]) -> Optional[float]:
        """Handles the end of a stream, with ``error`` or without one. Returns None if the reply is
        complete, else the seconds until the next attempt. Raises the error of a failed call."""
        answered = self._reply.header is not None
        ended = self._reply.end_stream(error)
        if ended is None:
            return None
        if self._resumed_after and ended.code is grpc.StatusCode.NOT_FOUND:
            raise self._model_is_gone(ended)
        return self.attempts.wait_after(ended, answered)

    def no_turn(self, calls: int) -> DuetError:
        """The error of a call whose timeout expires before its client may start it."""
        return make_error(
            grpc.StatusCode.DEADLINE_EXCEEDED,
            f"timeout: expected a turn among max_concurrent_calls={calls} calls of this client, got "
            f"none in {self.attempts.timeout:g} s; raise the timeout or max_concurrent_calls")

    def result(self) -> SynthesisResult:
        return self._reply.result(self.attempts.made, self._first_chunk[0], self.attempts.elapsed())

    def _model_is_gone(self, error: DuetError) -> DuetError:
        model = self._wire.model
        return make_error(
            grpc.StatusCode.ABORTED,
            f"the stream broke after {self._resumed_after} frames and cannot be resumed: "
            f"{model.name}@{model.version} is no longer served",
            violations=error.violations, reason=error.reason, retry_delay=error.retry_delay)
