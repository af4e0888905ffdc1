"""When a failed call is made again, as the C++ client decides it (client/internal/retry.h)."""

from __future__ import annotations

import dataclasses
from typing import Callable, Optional

import grpc

from duet.errors import DuetError


@dataclasses.dataclass(frozen=True)
class RetryOptions:
    """How often and how patiently a call is attempted.

    The wait before attempt n + 1 is drawn from [0.5, 1] x min(max_backoff, initial_backoff x
    2^(n-1)) and is never shorter than what the server asked for. Unless there is a limit to their
    number, the deadline alone ends the attempts: a server that restarts is away for seconds.
    UNAVAILABLE and replies that break off are tried again; a full server only for bulk work.

    Raises:
        ValueError: a field makes no sense.
    """

    max_attempts: Optional[int] = None
    """1: never again. None: until the deadline."""
    initial_backoff: float = 0.1
    """Seconds."""
    max_backoff: float = 5.0
    """Seconds."""
    on_wait: Optional[Callable[[DuetError, float], None]] = None
    """Told before each wait: why, and for how many seconds."""

    def __post_init__(self) -> None:
        if self.max_attempts is not None and self.max_attempts < 1:
            raise ValueError(f"retry.max_attempts: {self.max_attempts}, wanted 1 or more")
        if not 0 < self.initial_backoff <= self.max_backoff:
            raise ValueError(f"retry: initial_backoff {self.initial_backoff}, max_backoff "
                             f"{self.max_backoff}, wanted 0 < initial <= max")


def is_retryable(error: DuetError, priority: str) -> bool:
    """Whether another attempt may succeed where this one failed."""
    if error.code is grpc.StatusCode.UNAVAILABLE:
        return True
    if error.code is grpc.StatusCode.CANCELLED:
        # A server that shuts down ends so what it has not begun to look at. (Whoever cancels a call
        # here is not asked.)
        return not (error.reason or error.violations or error.retry_delay is not None)
    return (error.code is grpc.StatusCode.RESOURCE_EXHAUSTED and priority == "bulk"
            and error.retry_delay is not None)


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
