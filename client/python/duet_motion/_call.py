"""A call, whoever carries its messages: attempts, deadline, pinned model, the reply so far."""

from __future__ import annotations

import dataclasses
import random
import time
from typing import Callable, List, Optional, Tuple

import grpc

from duet_motion._fields import with_joint_names
from duet_motion._reply import ReplyAssembler
from duet_motion.errors import DuetError, make_error
from duet_motion.motion import checked_number
from duet_motion.request import SynthesisRequest, to_proto
from duet_motion.result import FollowerChunk, SynthesisResult
from duet_motion.retry import RetryOptions, is_retryable, is_unreachable, retry_wait
from duet_motion.v1 import synthesis_pb2

Metadata = Tuple[Tuple[str, str], ...]


@dataclasses.dataclass(frozen=True)
class Environment:
    """Time and chance, replaced in tests."""

    now: Callable[[], float] = time.monotonic
    """Seconds."""
    uniform: Callable[[], float] = random.random
    """In [0, 1)."""


@dataclasses.dataclass(frozen=True)
class CallSettings:
    """What every call of a client has in common."""

    timeout: float
    """Seconds for a whole call, all its attempts included."""
    retry: RetryOptions
    metadata: Metadata = ()
    environment: Environment = Environment()
    wait: float = 5.0
    """Seconds for which a server that cannot be reached is tried again."""
    address: str = ""
    """Of the server, for errors."""


class Attempts:
    """How often a call was made, and whether it is made again."""

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
        # The end of the first of the latest attempts in a row that reached no server.
        self._away_since: Optional[float] = None

    def seconds_left(self) -> float:
        """At least a moment."""
        return max(self.start + self.timeout - self._settings.environment.now(), 0.001)

    def begin(self) -> float:
        """Counts an attempt; the seconds that it has."""
        self.made += 1
        return self.seconds_left()

    def wait_after(self, error: DuetError, answered: bool = False) -> float:
        """Seconds until the next attempt; raises the error where there is none.

        ``answered``: the server sent part of a reply before the attempt failed.
        """
        options = self._settings.retry
        is_last = options.max_attempts is not None and self.made >= options.max_attempts
        if is_last or not is_retryable(error):
            raise self._after_attempts(error, "")
        environment = self._settings.environment
        now, wait = environment.now(), retry_wait(options, self.made, error, environment.uniform())
        if answered or not is_unreachable(error):
            self._away_since = None
        else:
            self._away_since = now if self._away_since is None else self._away_since
            left = self._away_since + self._settings.wait - now
            # The last attempt is made when the wait is over, not a whole backoff before that.
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
            f"address: expected a Duet server at {self._settings.address}, got {error.message!r} "
            f"({self._count()} in {self.elapsed():.1f} s); start duet-server there, name another "
            "address (DUET_SERVER), or wait longer (duet_motion.Client(wait=SECONDS))")

    def _after_attempts(self, error: DuetError, reason: str) -> DuetError:
        if self.made == 1 and not reason:
            return error
        return error.with_message(f"{error.message} (after {self._count()}{reason})")

    def _count(self) -> str:
        return f"{self.made} attempt{'' if self.made == 1 else 's'}"


class SynthesisCall:
    """One Synthesize call: what goes out, what is made of what comes back."""

    def __init__(self, request: SynthesisRequest, settings: CallSettings) -> None:
        self.attempts = Attempts(settings, request.timeout, request.request_id)
        self._wire = to_proto(request)
        self._leader = request.leader
        self._reply = ReplyAssembler(request.leader)
        self._first_chunk: List[float] = []
        self._resumed_after = 0

    def begin(self) -> Tuple[synthesis_pb2.SynthesizeRequest, float]:
        """The request of the next attempt, and the seconds that it has."""
        seconds = self.attempts.begin()
        self._resumed_after = self._reply.handed_out
        if self._resumed_after and self._reply.header is not None:
            # A follower must not be half one version's and half another's.
            self._wire.model.name = self._reply.header.model_name
            self._wire.model.version = self._reply.header.model_version
        self._reply.start_stream()
        return self._wire, seconds

    def accept(self, response: synthesis_pb2.SynthesizeResponse) -> Optional[FollowerChunk]:
        """Takes a message; frames that the caller does not have yet, where there are any."""
        chunk = self._reply.accept(response)
        if self._reply.received and not self._first_chunk:
            self._first_chunk.append(self.attempts.elapsed())
        return chunk

    def wait_after(self, error: Optional[DuetError]) -> Optional[float]:
        """After a stream ended with ``error`` or well: None where the reply is whole, else the
        seconds until the next attempt. Raises what the call fails with."""
        answered = self._reply.header is not None
        ended = self._reply.end_stream(error)
        if ended is None:
            return None
        if self._resumed_after and ended.code is grpc.StatusCode.NOT_FOUND:
            raise self._model_is_gone(ended)
        return self.attempts.wait_after(with_joint_names(ended, self._leader), answered)

    def no_turn(self, calls: int) -> DuetError:
        """What a call fails with whose time is over before its client may begin it."""
        return make_error(
            grpc.StatusCode.DEADLINE_EXCEEDED,
            f"timeout: expected a turn among max_concurrent_calls={calls} calls of this client, got "
            f"none in {self.attempts.timeout:g} s; give calls more time, or allow more at once")

    def result(self) -> SynthesisResult:
        return self._reply.result(self.attempts.made, self._first_chunk[0],
                                  self.attempts.elapsed())

    def _model_is_gone(self, error: DuetError) -> DuetError:
        model = self._wire.model
        return make_error(
            grpc.StatusCode.ABORTED,
            f"the stream broke after {self._resumed_after} frames and cannot be resumed: "
            f"{model.name}@{model.version} is no longer served",
            violations=error.violations, reason=error.reason, retry_delay=error.retry_delay)
