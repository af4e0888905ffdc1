"""A call, whoever carries its messages: attempts, deadline, pinned model, the reply so far."""

from __future__ import annotations

import dataclasses
import random
import time
from typing import Callable, List, Optional, Tuple

import grpc

from duet._reply import ReplyAssembler
from duet.errors import DuetError, make_error
from duet.request import SynthesisRequest, to_proto
from duet.result import FollowerChunk, SynthesisResult
from duet.retry import RetryOptions, is_retryable, retry_wait
from duet.v1 import synthesis_pb2

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


class Attempts:
    """How often a call was made, and whether it is made again."""

    def __init__(self, settings: CallSettings, priority: str = "interactive",
                 request_id: str = "") -> None:
        self._settings = settings
        self._priority = priority
        self.start = settings.environment.now()
        self.metadata: Metadata = settings.metadata
        if request_id:
            self.metadata += (("x-request-id", request_id),)
        self.made = 0

    def begin(self) -> float:
        """Counts an attempt; the seconds that it has, at least a moment."""
        self.made += 1
        return max(self.start + self._settings.timeout - self._settings.environment.now(), 0.001)

    def wait_after(self, error: DuetError) -> float:
        """Seconds until the next attempt; raises the error where there is none."""
        options = self._settings.retry
        is_last = options.max_attempts is not None and self.made >= options.max_attempts
        if is_last or not is_retryable(error, self._priority):
            raise self._tell(error, "")
        environment = self._settings.environment
        wait = retry_wait(options, self.made, error, environment.uniform())
        if environment.now() + wait >= self.start + self._settings.timeout:
            raise self._tell(error, ", the deadline leaves no time for another")
        if options.on_wait is not None:
            options.on_wait(error, wait)
        return wait

    def elapsed(self) -> float:
        return self._settings.environment.now() - self.start

    def _tell(self, error: DuetError, reason: str) -> DuetError:
        if self.made == 1 and not reason:
            return error
        attempts = f"{self.made} attempt{'' if self.made == 1 else 's'}"
        return error.with_message(f"{error.message} (after {attempts}{reason})")


class SynthesisCall:
    """One Synthesize call: what goes out, what is made of what comes back."""

    def __init__(self, request: SynthesisRequest, settings: CallSettings) -> None:
        self.attempts = Attempts(settings, request.priority, request.request_id)
        self._wire = to_proto(request)
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
        ended = self._reply.end_stream(error)
        if ended is None:
            return None
        if self._resumed_after and ended.code is grpc.StatusCode.NOT_FOUND:
            raise self._model_is_gone(ended)
        return self.attempts.wait_after(ended)

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
