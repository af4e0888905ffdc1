"""How a client reaches its server."""

from __future__ import annotations

import json
from typing import Any, List, Optional, Tuple

import grpc

from duet._call import CallSettings, Metadata
from duet.options import TlsOptions
from duet.retry import RetryOptions

_SCHEMES = ("dns:", "ipv4:", "ipv6:", "unix:", "unix-abstract:", "xds:")
_LOCAL = ("localhost", "127.", "[::1]", "ipv4:127.", "ipv6:[::1]", "unix:", "unix-abstract:",
          "dns:///localhost", "dns:localhost")

# Calls take turns over all servers behind the name whose health service says that they serve, so
# that a draining server gets no new work. The empty service name asks for the server as a whole.
_SERVICE_CONFIG = json.dumps({
    "loadBalancingConfig": [{"round_robin": {}}],
    "healthCheckConfig": {"serviceName": ""},
})


def target(address: str) -> str:
    """The gRPC target of an address."""
    return address if address.startswith(_SCHEMES) else f"dns:///{address}"


def channel_arguments(retry: RetryOptions, tls: Optional[TlsOptions]) -> List[Tuple[str, Any]]:
    arguments: List[Tuple[str, Any]] = [
        ("grpc.lb_policy_name", "round_robin"),
        ("grpc.service_config", _SERVICE_CONFIG),
        # A lost connection is tried again as soon as a call is. With gRPC's own first wait of a
        # second, a call could use up its attempts while the server has long been back.
        ("grpc.initial_reconnect_backoff_ms", max(int(retry.initial_backoff * 1000), 1)),
        ("grpc.max_reconnect_backoff_ms", max(int(retry.max_backoff * 1000), 1)),
        # gRPC's own retries would come on top of ours.
        ("grpc.enable_retries", 0),
    ]
    if tls is not None and tls.server_name:
        arguments.append(("grpc.ssl_target_name_override", tls.server_name))
    return arguments


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
    if tls is None and not address.startswith(_LOCAL):
        raise ValueError("token: wanted together with tls; on a plain connection whoever is on the "
                         "way reads it")
    return (("authorization", f"Bearer {token}"),)
