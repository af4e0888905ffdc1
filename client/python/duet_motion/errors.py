"""What a call may fail with.

Every refusal of a server is a :class:`DuetError`, of the subclass that its status code has. What is
wrong before a server is asked (an array of the wrong shape) is Python's own ``ValueError``.
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
    """A field of a request that the server refused."""

    field: str
    """Such as ``leader.positions[17]``."""
    description: str
    """What came and what was wanted."""


class DuetError(Exception):
    """A call that failed."""

    def __init__(self, code: grpc.StatusCode, message: str,
                 violations: Tuple[FieldViolation, ...] = (), reason: str = "",
                 retry_delay: float | None = None) -> None:
        super().__init__(code, message, violations, reason, retry_delay)
        self.code = code
        """The gRPC status code."""
        self.message = message
        """For people; names each refused field."""
        self.violations = violations
        """Every field that was refused, in the server's order; none where it is another refusal."""
        self.reason = reason
        """Stable and machine-readable, such as ``"QUEUE_FULL"``; empty where no Duet server said
        it."""
        self.retry_delay = retry_delay
        """After how many seconds the server wants to be asked again; None where it did not say."""

    def __str__(self) -> str:
        return f"{self.code.name}: {self.message}"

    @property
    def is_permanent(self) -> bool:
        """Whether the same call will fail again however often it is made."""
        if self.code is grpc.StatusCode.RESOURCE_EXHAUSTED:
            return self.retry_delay is None
        return self.code in _PERMANENT

    def with_message(self, message: str) -> DuetError:
        """The same refusal in other words."""
        return type(self)(self.code, message, self.violations, self.reason, self.retry_delay)


class InvalidRequestError(DuetError, ValueError):
    """INVALID_ARGUMENT: fields are malformed; ``violations`` has each."""


class RequestMismatchError(DuetError):
    """FAILED_PRECONDITION: the request does not fit the model."""


class ModelNotFoundError(DuetError, LookupError):
    """NOT_FOUND: no such model, version or version label."""


class ServerBusyError(DuetError):
    """RESOURCE_EXHAUSTED: the queue is full (``retry_delay``), or the message is too large."""


class UnavailableError(DuetError, ConnectionError):
    """UNAVAILABLE: the server is away, loading or draining, or a reply broke off."""


class DeadlineError(DuetError, TimeoutError):
    """DEADLINE_EXCEEDED: the time for the call is over, or too short for it."""


class CancelledError(DuetError):
    """CANCELLED: the call was ended by its caller."""


class NotPermittedError(DuetError, PermissionError):
    """UNAUTHENTICATED or PERMISSION_DENIED: the credentials are refused."""


class MalformedReplyError(DuetError):
    """The server's reply breaks the contract."""


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
    """An error of the class that the code has."""
    return _CLASSES.get(code, DuetError)(code, message, **details)


def from_rpc_error(error: Any) -> DuetError:
    """What a ``grpc.RpcError`` says, with the google.rpc details that came with it."""
    details = _read_details(error.trailing_metadata() or ())
    bad_request = _read(details, "BadRequest", status_pb2.BadRequest.FromString)
    info = _read(details, "ErrorInfo", status_pb2.ErrorInfo.FromString)
    retry = _read(details, "RetryInfo", status_pb2.RetryInfo.FromString)
    violations = tuple(FieldViolation(violation.field, violation.description)
                       for violation in (bad_request.field_violations if bad_request else ()))
    delay = retry and retry.retry_delay.seconds + retry.retry_delay.nanos / 1e9
    return make_error(error.code(), _tell(error.details() or "", violations),
                      violations=violations, reason=info.reason if info else "",
                      retry_delay=None if delay is None else max(delay, 0.0))


def _read_details(metadata: Any) -> Dict[str, bytes]:
    """The google.rpc details by their names; none where they cannot be read."""
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


def _tell(message: str, violations: Tuple[FieldViolation, ...]) -> str:
    """The message, with those violations that it does not name itself."""
    untold = [f"{violation.field}: {violation.description}" if violation.field
              else violation.description for violation in violations
              if violation.field not in message or violation.description not in message]
    return ": ".join(part for part in (message, "; ".join(untold)) if part)
