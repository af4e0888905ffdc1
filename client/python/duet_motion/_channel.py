"""The connection to a server, shared by the blocking and the asynchronous client."""

from __future__ import annotations

import json
import re
import threading
from typing import Any, ClassVar, List, Optional, Tuple, TypeVar, Union

import grpc

from duet_motion import _settings
from duet_motion._call import CallSettings, Metadata
from duet_motion.errors import CancelledError
from duet_motion.motion import checked_number
from duet_motion.options import TlsOptions
from duet_motion.retry import RetryOptions
from duet_motion.v1 import synthesis_pb2_grpc

_Value = TypeVar("_Value")

_SCHEMES = ("dns:", "ipv4:", "ipv6:", "unix:", "unix-abstract:", "xds:")
# Addresses that a token may be sent to in plain text, because it does not leave this machine. Other
# host names may resolve to any machine.
_THIS_MACHINE = re.compile(
    r"(unix:|unix-abstract:).*|((dns:///|dns:|ipv4:)?(localhost|127\.[\d.]+)|(ipv6:)?\[::1\])(:\d+)?")
_LONGEST_RECONNECT_SECONDS = 1.0
_CONNECT_TIMEOUT_SECONDS = 5.0

DEFAULT_ADDRESS = "localhost:50051"
DEFAULT_TIMEOUT = 120.0
DEFAULT_WAIT = 5.0
# Few enough that a server with default limits takes all of them, enough to keep it busy.
DEFAULT_CONCURRENT_CALLS = 16

# Round robin over all servers of the name whose health service reports SERVING, so that a draining
# server gets no new calls. The empty service name stands for the whole server.
_SERVICE_CONFIG = json.dumps({
    "loadBalancingConfig": [{"round_robin": {}}],
    "healthCheckConfig": {"serviceName": ""},
})


class Connected:
    """Base of both clients: settings, a channel and its stub."""

    _grpc: ClassVar[Any]
    """The module that creates channels: ``grpc`` or ``grpc.aio``."""
    _semaphore: ClassVar[Any]
    """Limits concurrent calls: ``threading.Semaphore`` or ``asyncio.Semaphore``."""

    def __init__(self, address: Optional[str] = None, *, timeout: Optional[float] = None,
                 wait: Optional[float] = None, tls: Union[TlsOptions, bool, None] = None,
                 token: Optional[str] = None, authority: Optional[str] = None,
                 retry: RetryOptions = RetryOptions(),
                 max_concurrent_calls: int = DEFAULT_CONCURRENT_CALLS) -> None:
        address = _first(address, _settings.text("SERVER"), DEFAULT_ADDRESS)
        token = _first(token, _settings.token(), "")
        authority = _first(authority, _settings.text("AUTHORITY"), "")
        options = _settings.tls() if tls is None else tls_options(tls)
        self._settings = check_settings(
            address, _first(timeout, _settings.seconds("TIMEOUT"), DEFAULT_TIMEOUT),
            _first(wait, _settings.seconds("WAIT"), DEFAULT_WAIT), retry, options, token)
        if max_concurrent_calls < 1:
            raise ValueError(f"max_concurrent_calls: expected 1 or more, got {max_concurrent_calls}")
        self._max_concurrent_calls = max_concurrent_calls
        self._turns = self._semaphore(max_concurrent_calls)
        arguments = channel_arguments(retry, options, token, authority)
        if options is None:
            self._channel = self._grpc.insecure_channel(target(address), arguments)
        else:
            self._channel = self._grpc.secure_channel(target(address), credentials(options),
                                                      arguments)
        self._closed = threading.Event()
        self._stub = synthesis_pb2_grpc.MotionSynthesisStub(  # type: ignore[no-untyped-call]
            self._channel)


def _first(argument: Optional[_Value], setting: Optional[_Value], default: _Value) -> _Value:
    if argument is not None:
        return argument
    return default if setting is None else setting


def tls_options(tls: Union[TlsOptions, bool]) -> Optional[TlsOptions]:
    """The TLS options for ``tls``; None for plain text."""
    if isinstance(tls, bool):
        return TlsOptions() if tls else None
    return tls


def check_open(closed: threading.Event) -> None:
    if closed.is_set():
        raise CancelledError(grpc.StatusCode.CANCELLED, "the client was closed")


def target(address: str) -> str:
    """The gRPC target of an address."""
    return address if address.startswith(_SCHEMES) else f"dns:///{address}"


def channel_arguments(retry: RetryOptions, tls: Optional[TlsOptions], token: str = "",
                      authority: str = "") -> List[Tuple[str, Any]]:
    arguments: List[Tuple[str, Any]] = [
        ("grpc.lb_policy_name", "round_robin"),
        ("grpc.service_config", _SERVICE_CONFIG),
        # Reconnect as often as calls are retried. gRPC's own backoff grows to two minutes, so it
        # would notice a restarted server late.
        ("grpc.initial_reconnect_backoff_ms", _milliseconds(retry.initial_backoff)),
        ("grpc.max_reconnect_backoff_ms", _milliseconds(max(
            retry.initial_backoff, min(retry.max_backoff, _LONGEST_RECONNECT_SECONDS)))),
        # In spite of its name, this option is the minimum timeout of a connection attempt. The
        # default of 20 s is too long if a firewall drops packets.
        ("grpc.min_reconnect_backoff_ms", _milliseconds(_CONNECT_TIMEOUT_SECONDS)),
        # Retries are made by duet_motion.retry.
        ("grpc.enable_retries", 0),
    ]
    if tls is not None and tls.server_name:
        arguments.append(("grpc.ssl_target_name_override", tls.server_name))
    if token and tls is None:
        # A token in plain text must not pass through the environment's proxy.
        arguments.append(("grpc.enable_http_proxy", 0))
    if authority:
        arguments.append(("grpc.default_authority", authority))
    return arguments


def _milliseconds(seconds: float) -> int:
    return max(int(seconds * 1000), 1)


def credentials(tls: TlsOptions) -> grpc.ChannelCredentials:
    return grpc.ssl_channel_credentials(tls.root_certificates or None, tls.private_key or None,
                                        tls.certificate_chain or None)


def check_settings(address: str, timeout: float, wait: float, retry: RetryOptions,
                   tls: Optional[TlsOptions], token: str) -> CallSettings:
    """Settings of every call. Raises ValueError for an invalid value."""
    if not address:
        raise ValueError("address: expected host:port, got an empty string")
    checked_number("timeout", timeout, above=0)
    if not 0 <= wait < float("inf"):
        raise ValueError(f"wait: expected a number of seconds, 0 or more, got {wait}")
    return CallSettings(timeout, retry, _authorization(address, tls, token), wait=wait,
                        address=address)


def _authorization(address: str, tls: Optional[TlsOptions], token: str) -> Metadata:
    if not token:
        return ()
    if not all("!" <= character <= "~" for character in token):
        # The message does not repeat the token, because messages are logged.
        raise ValueError("token: expected printable ASCII without blanks, got other characters")
    if tls is None and not _THIS_MACHINE.fullmatch(address):
        raise ValueError(f"token: expected tls, got plain text to {address}")
    return (("authorization", f"Bearer {token}"),)
