"""When a failed call is made again, as the C++ client decides it (client/internal/retry.h)."""

from __future__ import annotations

import dataclasses
from typing import Callable, Optional

import grpc

from duet_motion.errors import DuetError


@dataclasses.dataclass(frozen=True)
class RetryOptions:
    """How often and how patiently a call is attempted.

    The wait before attempt n + 1 is drawn from [0.5, 1] x min(max_backoff, initial_backoff x
    2^(n-1)) and is never shorter than what the server asks for. UNAVAILABLE, replies that break off,
    and refusals by a full server that says when to come back are tried again: until the call's
    timeout, or, where no server can be reached, for the client's ``wait``.

    Args:
        max_attempts: how often a call is made; 1: never again. None: no limit.
        initial_backoff: seconds before the second attempt.
        max_backoff: the longest wait in seconds, unless the server asks for more.
        on_wait: called before each wait with the error and the seconds of the wait.

    Raises:
        ValueError: a field makes no sense.
    """

    max_attempts: Optional[int] = None
    initial_backoff: float = 0.1
    max_backoff: float = 5.0
    on_wait: Optional[Callable[[DuetError, float], None]] = None

    def __post_init__(self) -> None:
        if self.max_attempts is not None and self.max_attempts < 1:
            raise ValueError(f"retry.max_attempts: expected 1 or more, got {self.max_attempts}")
        if not 0 < self.initial_backoff <= self.max_backoff:
            raise ValueError("retry: expected 0 < initial_backoff <= max_backoff, got "
                             f"{self.initial_backoff} and {self.max_backoff}")


def is_retryable(error: DuetError) -> bool:
    """Whether another attempt may succeed where this one failed."""
    if error.code is grpc.StatusCode.UNAVAILABLE:
        return True
    if error.code is grpc.StatusCode.CANCELLED:
        # A server that shuts down ends so what it has not begun to look at. (Whoever cancels a call
        # here is not asked.)
        return not _has_details(error)
    # Without a delay the code means a message that is too large. The C++ client tries only bulk
    # work again; here many calls at a time are an everyday idiom, and each has its own timeout.
    return (error.code is grpc.StatusCode.RESOURCE_EXHAUSTED
            and error.retry_delay is not None)


def is_unreachable(error: DuetError) -> bool:
    """Whether gRPC itself says UNAVAILABLE: Duet servers send details with theirs, and one whose
    health service says NOT_SERVING ("backend unhealthy") is reachable."""
    return (error.code is grpc.StatusCode.UNAVAILABLE and not _has_details(error)
            and "unhealthy" not in error.message)


def _has_details(error: DuetError) -> bool:
    return bool(error.reason or error.violations or error.retry_delay is not None)


def retry_wait(options: RetryOptions, attempt: int, error: DuetError, uniform: float) -> float:
    """Seconds to wait after the ``attempt``-th attempt (from 1) failed.

    ``uniform``, in [0, 1), spreads the waits, also those that the server asks for, so that clients
    sent away together do not return together.
    """
    ceiling = min(options.initial_backoff * 2.0**min(attempt - 1, 60), options.max_backoff)
    backoff = ceiling * (0.5 + 0.5 * uniform)
    if error.retry_delay is None or error.retry_delay < backoff:
        return backoff
    return error.retry_delay + ceiling * 0.5 * uniform
