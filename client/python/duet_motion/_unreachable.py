"""Says in words why gRPC had no server for a call, like the C++ client (client/internal/retry.cc)."""

from __future__ import annotations

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


def describe_unreachable(address: str, message: str) -> str:
    """A sentence about the server at ``address``. ``message``, gRPC's own, is part of it only if the
    cause is unknown."""
    for sign, text in _CAUSES:
        if sign in message:
            return f"the server at {address} {text}"
    return f"the server at {address} cannot be reached: {message}"
