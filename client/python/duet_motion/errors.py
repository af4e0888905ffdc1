"""Errors of calls.

Every error from a server is a :class:`DuetError`; its status code selects the subclass. An error
that is found without a server, such as an array of the wrong shape, is a ``ValueError``.
"""

from __future__ import annotations

import dataclasses
from typing import Any, Callable, Dict, Tuple, Type, TypeVar

import grpc
from google.protobuf.message import DecodeError

from duet_motion.rpc.v1 import status_pb2

_DETAILS = "grpc-status-details-bin"
_Detail = TypeVar("_Detail")


@dataclasses.dataclass(frozen=True)
class FieldViolation:
    """A field of a request that the server rejected."""

    field: str
    """The field, such as ``leader.positions[17]``."""
    description: str
    """What was expected and what the server got."""


class DuetError(Exception):
    """A call that failed."""

    def __init__(self, code: grpc.StatusCode, message: str,
                 violations: Tuple[FieldViolation, ...] = (), reason: str = "",
                 retry_delay: float | None = None) -> None:
        super().__init__(code, message, violations, reason, retry_delay)
        self.code = code
        """The gRPC status code."""
        self.message = message
        """A readable message that names each rejected field."""
        self.violations = violations
        """Every rejected field, in the server's order; empty for errors that are not about
        fields."""
        self.reason = reason
        """Stable and machine-readable, such as ``"QUEUE_FULL"``; empty if the error is not from a
        Duet server."""
        self.retry_delay = retry_delay
        """Seconds to wait before a retry, as requested by the server; None without a request."""

    def __str__(self) -> str:
        return f"{self.code.name}: {self.message}"

    @property
    def is_permanent(self) -> bool:
        """Whether the same call can never succeed."""
        if self.code is grpc.StatusCode.RESOURCE_EXHAUSTED:
            return self.retry_delay is None
        return self.code in _PERMANENT

    def with_message(self, message: str) -> DuetError:
        """The same error with another message."""
        return type(self)(self.code, message, self.violations, self.reason, self.retry_delay)


class InvalidRequestError(DuetError, ValueError):
    """INVALID_ARGUMENT: fields are invalid; ``violations`` lists them."""


class RequestMismatchError(DuetError):
    """FAILED_PRECONDITION: the request does not fit the model."""


class ModelNotFoundError(DuetError, LookupError):
    """NOT_FOUND: no such model, version or version label."""


class ServerBusyError(DuetError):
    """RESOURCE_EXHAUSTED: the queue is full (``retry_delay``), or the message is too large."""


class UnavailableError(DuetError, ConnectionError):
    """UNAVAILABLE: the server cannot be reached, loads or drains, or a reply broke off."""


class DeadlineError(DuetError, TimeoutError):
    """DEADLINE_EXCEEDED: the call's timeout expired, or is shorter than the expected wait."""


class CancelledError(DuetError):
    """CANCELLED: the caller ended the call."""


class NotPermittedError(DuetError, PermissionError):
    """UNAUTHENTICATED or PERMISSION_DENIED: the server rejected the credentials."""


class MalformedReplyError(DuetError):
    """The server's reply violates the API."""


_CLASSES: Dict[grpc.StatusCode, Type[DuetError]] = {
    grpc.StatusCode.INVALID_ARGUMENT: InvalidRequestError,
    grpc.StatusCode.FAILED_PRECONDITION: RequestMismatchError,
    grpc.StatusCode.NOT_FOUND: ModelNotFoundError,
    grpc.StatusCode.RESOURCE_EXHAUSTED: ServerBusyError,
    grpc.StatusCode.UNAVAILABLE: UnavailableError,
    grpc.StatusCode.DEADLINE_EXCEEDED: DeadlineError,
    grpc.StatusCode.CANCELLED: CancelledError,
    grpc.StatusCode.UNAUTHENTICATED: NotPermittedError,
    grpc.StatusCode.PERMISSION_DENIED: NotPermittedError,
}
_PERMANENT = frozenset({
    grpc.StatusCode.INVALID_ARGUMENT, grpc.StatusCode.FAILED_PRECONDITION,
    grpc.StatusCode.OUT_OF_RANGE, grpc.StatusCode.NOT_FOUND, grpc.StatusCode.ALREADY_EXISTS,
    grpc.StatusCode.PERMISSION_DENIED, grpc.StatusCode.UNAUTHENTICATED,
    grpc.StatusCode.UNIMPLEMENTED,
})


def make_error(code: grpc.StatusCode, message: str, **details: Any) -> DuetError:
    """Creates an error of the class for ``code``."""
    return _CLASSES.get(code, DuetError)(code, message, **details)


def from_rpc_error(error: Any) -> DuetError:
    """Converts a ``grpc.RpcError`` with its google.rpc details."""
    details = _read_details(error.trailing_metadata() or ())
    bad_request = _read(details, "BadRequest", status_pb2.BadRequest.FromString)
    info = _read(details, "ErrorInfo", status_pb2.ErrorInfo.FromString)
    retry = _read(details, "RetryInfo", status_pb2.RetryInfo.FromString)
    violations = tuple(FieldViolation(violation.field, violation.description)
                       for violation in (bad_request.field_violations if bad_request else ()))
    delay = retry and retry.retry_delay.seconds + retry.retry_delay.nanos / 1e9
    return make_error(error.code(), _with_violations(error.details() or "", violations),
                      violations=violations, reason=info.reason if info else "",
                      retry_delay=None if delay is None else max(delay, 0.0))


def _read_details(metadata: Any) -> Dict[str, bytes]:
    """The google.rpc details by name; empty if they are malformed."""
    for key, value in metadata:
        if key == _DETAILS:
            try:
                status = status_pb2.Status.FromString(value)
            except DecodeError:
                return {}
            return {detail.type_url.rpartition("/")[2]: detail.value for detail in status.details}
    return {}


def _read(details: Dict[str, bytes], name: str,
          parse: Callable[[bytes], _Detail]) -> _Detail | None:
    data = details.get(f"google.rpc.{name}")
    try:
        return None if data is None else parse(data)
    except DecodeError:
        return None


def _with_violations(message: str, violations: Tuple[FieldViolation, ...]) -> str:
    """The message, extended by the violations that it does not already name."""
    missing = [f"{violation.field}: {violation.description}" if violation.field
              else violation.description for violation in violations
              if violation.field not in message or violation.description not in message]
    return ": ".join(part for part in (message, "; ".join(missing)) if part)
