"""How a client reaches its server, whether its calls wait or are awaited."""

from __future__ import annotations

import json
import re
import threading
from typing import Any, ClassVar, List, Optional, Tuple

import grpc

from duet._call import CallSettings, Metadata
from duet.errors import CancelledError
from duet.options import TlsOptions
from duet.retry import RetryOptions
from duet.v1 import synthesis_pb2_grpc

_SCHEMES = ("dns:", "ipv4:", "ipv6:", "unix:", "unix-abstract:", "xds:")
# What a token may be sent to in plain text: it leaves this machine by no network. A host name other
# than localhost may be anybody's, and of several addresses each would have to be looked at.
_THIS_MACHINE = re.compile(
    r"(unix:|unix-abstract:).*|((dns:///|dns:|ipv4:)?(localhost|127\.[\d.]+)|(ipv6:)?\[::1\])(:\d+)?")
_LONGEST_RECONNECT_SECONDS = 1.0

# Calls take turns over all servers behind the name whose health service says that they serve, so
# that a draining server gets no new work. The empty service name asks for the server as a whole.
_SERVICE_CONFIG = json.dumps({
    "loadBalancingConfig": [{"round_robin": {}}],
    "healthCheckConfig": {"serviceName": ""},
})


class Connected:
    """What both clients are made of: settings, a channel, and the stub that speaks over it."""

    _grpc: ClassVar[Any]
    """The module whose channels carry the calls: ``grpc`` or ``grpc.aio``."""

    def __init__(self, address: str = "localhost:50051", *, timeout: float = 120.0,
                 tls: Optional[TlsOptions] = None, token: str = "",
                 authority: str = "", retry: RetryOptions = RetryOptions()) -> None:
        self._settings = check_settings(address, timeout, retry, tls, token)
        arguments = channel_arguments(retry, tls, token, authority)
        if tls is None:
            self._channel = self._grpc.insecure_channel(target(address), arguments)
        else:
            self._channel = self._grpc.secure_channel(target(address), credentials(tls), arguments)
        self._closed = threading.Event()
        self._stub = synthesis_pb2_grpc.MotionSynthesisStub(  # type: ignore[no-untyped-call]
            self._channel)


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
        # A lost connection is tried again as soon as a call is, and often: gRPC's own waits grow to
        # two minutes, while the server has long been back.
        ("grpc.initial_reconnect_backoff_ms", _milliseconds(retry.initial_backoff)),
        ("grpc.max_reconnect_backoff_ms", _milliseconds(max(
            retry.initial_backoff, min(retry.max_backoff, _LONGEST_RECONNECT_SECONDS)))),
        # gRPC's own retries would come on top of ours.
        ("grpc.enable_retries", 0),
    ]
    if tls is not None and tls.server_name:
        arguments.append(("grpc.ssl_target_name_override", tls.server_name))
    if token and tls is None:
        # Plain text to this machine must not take the way of the environment's proxy.
        arguments.append(("grpc.enable_http_proxy", 0))
    if authority:
        arguments.append(("grpc.default_authority", authority))
    return arguments


def _milliseconds(seconds: float) -> int:
    return max(int(seconds * 1000), 1)


def credentials(tls: TlsOptions) -> grpc.ChannelCredentials:
    return grpc.ssl_channel_credentials(root_certificates=tls.root_certificates or None,
                                        private_key=tls.private_key or None,
                                        certificate_chain=tls.certificate_chain or None)


def check_settings(address: str, timeout: float, retry: RetryOptions, tls: Optional[TlsOptions],
                   token: str) -> CallSettings:
    """What every call has in common. Raises ValueError naming what makes no sense."""
    if not address:
        raise ValueError("address: empty, wanted host:port")
    if not timeout > 0:
        raise ValueError(f"timeout: {timeout}, wanted more than 0")
    return CallSettings(timeout, retry, _authorization(address, tls, token))


def _authorization(address: str, tls: Optional[TlsOptions], token: str) -> Metadata:
    if not token:
        return ()
    if not all("!" <= character <= "~" for character in token):
        # Not repeated: messages go to logs.
        raise ValueError("token: has a blank or a character that is not printable ASCII, wanted "
                         "none")
    if tls is None and not _THIS_MACHINE.fullmatch(address):
        raise ValueError(f"token: would travel in plain text to {address}, wanted tls")
    return (("authorization", f"Bearer {token}"),)
