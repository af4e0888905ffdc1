"""Decides whether to retry a failed call, like the C++ client (client/internal/retry.h)."""

from __future__ import annotations

import dataclasses
from typing import Callable, Optional

import grpc

from duet_motion.errors import DuetError

# Part of gRPC's message, and what follows the address. The first one that is found applies: gRPC's
# message of a failed handshake contains its cause.
_CAUSES = (
    ("unhealthy", "is not ready: it loads its models, or it shuts down"),
    ("Connection refused", "is not running: it refused the connection"),
    ("No such file or directory", "is not running: its socket does not exist"),
    ("DNS resolution failed", "cannot be found: the name has no address"),
    ("http1.x", "is not a Duet server: it does not speak gRPC"),
    ("HTTP/2", "is not a Duet server: it does not speak gRPC"),
    ("wrong version number", "does not encrypt, but this client does"),
    ("certificate verify failed", "is not trusted: its certificate was not accepted"),
    ("CERTIFICATE_VERIFY_FAILED", "is not trusted: its certificate was not accepted"),
    ("Ssl handshake failed", "cannot be reached: the TLS handshake failed"),
    ("timed out", "does not answer: the connection timed out"),
    ("No route to host", "cannot be reached: there is no route to it"),
    ("Network is unreachable", "cannot be reached: there is no route to it"),
    # A server that encrypts does so to a client that does not.
    ("Connection reset", "closed the connection: it has stopped, or it expects TLS"),
    ("Socket closed", "closed the connection: it has stopped, or it expects TLS"),
)


@dataclasses.dataclass(frozen=True)
class RetryOptions:
    """Number of attempts and backoff of calls.

    The wait before attempt n + 1 is drawn from [0.5, 1] x min(max_backoff, initial_backoff x
    2^(n-1)) and is never shorter than the delay that the server requests. UNAVAILABLE, replies that
    break off, and errors of a full server that requests a delay are retried until the call's
    timeout. If no server can be reached, they are retried for the client's ``wait``.

    Args:
        max_attempts: maximum number of attempts; 1: no retry. None: no limit.
        initial_backoff: seconds before the second attempt.
        max_backoff: the longest wait in seconds, unless the server requests more.
        on_wait: called before each wait with the error and the seconds of the wait.

    Raises:
        ValueError: a field is invalid.
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
    """Whether another attempt may succeed."""
    if error.code is grpc.StatusCode.UNAVAILABLE:
        return True
    if error.code is grpc.StatusCode.CANCELLED:
        # A server that shuts down cancels calls that it has not started. (Calls that this process
        # cancels never get here.)
        return not _has_details(error)
    # Without a delay, the code means that the message is too large. The C++ client retries only
    # bulk calls; in Python, many concurrent calls are common, and each has its own timeout.
    return (error.code is grpc.StatusCode.RESOURCE_EXHAUSTED
            and error.retry_delay is not None)


def has_no_server(error: DuetError) -> bool:
    """Whether UNAVAILABLE comes from gRPC itself. Duet servers add details to theirs."""
    return error.code is grpc.StatusCode.UNAVAILABLE and not _has_details(error)


def is_unreachable(error: DuetError) -> bool:
    """Whether no server was reached. A server whose health service reports NOT_SERVING ("backend
    unhealthy") is reachable."""
    return has_no_server(error) and "unhealthy" not in error.message


def _has_details(error: DuetError) -> bool:
    return bool(error.reason or error.violations or error.retry_delay is not None)


def retry_wait(options: RetryOptions, attempt: int, error: DuetError, uniform: float) -> float:
    """Seconds to wait after the ``attempt``-th attempt (from 1) failed.

    ``uniform``, in [0, 1), spreads the waits, including those that the server requests, so that
    clients rejected at the same time do not retry at the same time.
    """
    ceiling = min(options.initial_backoff * 2.0**min(attempt - 1, 60), options.max_backoff)
    backoff = ceiling * (0.5 + 0.5 * uniform)
    if error.retry_delay is None or error.retry_delay < backoff:
        return backoff
    return error.retry_delay + ceiling * 0.5 * uniform


def describe_unreachable(address: str, message: str) -> str:
    """A sentence about the server at ``address``. ``message``, gRPC's own, is part of it only if the
    cause is unknown."""
    for sign, text in _CAUSES:
        if sign in message:
            return f"the server at {address} {text}"
    return f"the server at {address} cannot be reached: {message}"
