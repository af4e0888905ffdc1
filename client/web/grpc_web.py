"""gRPC-web (binary, over HTTP/1.1) to gRPC. Messages pass through as they are: both ways they are
length-prefixed alike; only the trailers travel as a last frame of the body."""

import base64
import re
import urllib.parse

import duet_motion as duet
import duet_motion._channel
import grpc

METHODS = tuple(f"/duet.v1.MotionSynthesis/{name}"
                for name in ("Synthesize", "ListModels", "GetModel"))
CONTENT_TYPES = ("application/grpc-web", "application/grpc-web+proto")
TRAILERS = 0x80  # in the first byte of a frame
PASSED_ON = ("authorization", "x-request-id")
TIMEOUT = re.compile(r"(\d{1,8})([HMSmun])")
SECONDS = {"H": 3600, "M": 60, "S": 1, "m": 1e-3, "u": 1e-6, "n": 1e-9}
LONGEST_SECONDS = 600  # of a call whose caller names no deadline


def connect(server, tls):
    target = duet._channel.target(server)
    arguments = duet._channel.channel_arguments(duet.RetryOptions(), tls)
    if tls is None:
        return grpc.insecure_channel(target, arguments)
    return grpc.secure_channel(target, duet._channel.credentials(tls), arguments)


def forward(handler, channel, path, body):
    """Answers a browser's call with the server's answer, message by message."""
    kind = handler.headers.get_content_type()
    if kind not in CONTENT_TYPES:
        start(handler, 415, "text/plain")
        write(handler, f"Content-Type: {kind}, wanted {CONTENT_TYPES[1]}".encode())
        end(handler)
        return
    start(handler, 200, CONTENT_TYPES[1])
    try:
        # A call of one answer is a stream of one.
        call = channel.unary_stream(path)(message_of(body), timeout=timeout_of(handler.headers),
                                          metadata=metadata_of(handler.headers))
    except ValueError as error:
        write(handler, trailers(grpc.StatusCode.INVALID_ARGUMENT, str(error), ()))
        end(handler)
        return
    try:
        try:
            for message in call:
                write(handler, frame(0, message))
        except grpc.RpcError:
            pass  # the call itself says how it ended
        write(handler, trailers(call.code(), call.details() or "", call.trailing_metadata() or ()))
        end(handler)
    finally:
        call.cancel()  # where the browser went away; otherwise of no effect


def message_of(body):
    """The one message of a request's body; ValueError where it is none."""
    if len(body) < 5 or body[0] != 0 or int.from_bytes(body[1:5], "big") != len(body) - 5:
        raise ValueError("body: wanted one frame of gRPC-web, not compressed")
    return body[5:]


def timeout_of(headers):
    found = TIMEOUT.fullmatch(headers.get("grpc-timeout", ""))
    return int(found[1]) * SECONDS[found[2]] if found else LONGEST_SECONDS


def metadata_of(headers):
    return tuple((name, headers[name]) for name in PASSED_ON if headers.get(name))


def frame(kind, data):
    return bytes([kind]) + len(data).to_bytes(4, "big") + data


def trailers(code, message, metadata):
    lines = [f"grpc-status: {code.value[0]}",
             f"grpc-message: {urllib.parse.quote(message, safe=' ')}"]
    for key, value in metadata:
        if key.endswith("-bin"):
            value = base64.b64encode(value).decode()
        lines.append(f"{key}: {value}")
    return frame(TRAILERS, "".join(f"{line}\r\n" for line in lines).encode())


def start(handler, status, kind):
    handler.send_response(status)
    handler.send_header("Content-Type", kind)
    handler.send_header("Transfer-Encoding", "chunked")
    handler.send_header("X-Accel-Buffering", "no")  # a proxy in between passes frames on at once
    handler.end_headers()


def write(handler, data):
    """One chunk of HTTP/1.1's own, at once."""
    handler.wfile.write(f"{len(data):x}\r\n".encode() + data + b"\r\n")


def end(handler):
    handler.wfile.write(b"0\r\n\r\n")
