"""Translates gRPC-web (binary, over HTTP/1.1) to gRPC. Both prefix messages with their length, so
messages pass through unchanged; gRPC-web sends the trailers as the last frame of the body."""

import asyncio
import base64
import contextlib
import os
import re
import typing
import urllib.parse

import duet_motion as duet
import duet_motion._channel
import duet_motion.retry
import grpc
import grpc.aio
from aiohttp import web
from serving import HEADERS, Rejected, shown

METHODS = tuple(f"/duet.v1.MotionSynthesis/{name}"
                for name in ("Synthesize", "ListModels", "GetModel"))
CONTENT_TYPES = ("application/grpc-web", "application/grpc-web+proto")
FRAME_BYTES = 5  # before each message: a flag and the length
TRAILERS = 0x80  # in the first byte of a frame
PASSED_ON = ("authorization", "x-request-id")
PRINTABLE = re.compile(r"[ -~]*")
TIMEOUT = re.compile(r"([0-9]{1,8})([HMSmun])")
SECONDS = {"H": 3600, "M": 60, "S": 1, "m": 1e-3, "u": 1e-6, "n": 1e-9}
LONGEST_SECONDS = 600  # of a call
RECONNECT_SECONDS = 2  # longer than a channel of duet_motion waits between attempts to connect
DETAILS = "grpc-status-details-bin"  # of an error that a Duet server reports


class Backend(typing.NamedTuple):
    """The Duet server behind the gateway."""
    address: str
    channel: grpc.aio.Channel


def connect(server, tls):
    """Returns the Backend of an address. Call it in the event loop that uses its channel."""
    target = duet._channel.target(server)
    arguments = duet._channel.channel_arguments(duet.RetryOptions(), tls)
    if tls is None:
        return Backend(server, grpc.aio.insecure_channel(target, arguments))
    credentials = duet._channel.credentials(tls)
    return Backend(server, grpc.aio.secure_channel(target, credentials, arguments))


async def reconnected(channel):
    """If the connection is lost, waits for the next attempt to connect, or until it is clear that the server
    is away. Until that attempt gRPC refuses calls, even if the server is back."""
    async def leave_failure():
        while channel.get_state(try_to_connect=True) is grpc.ChannelConnectivity.TRANSIENT_FAILURE:
            await channel.wait_for_state_change(grpc.ChannelConnectivity.TRANSIENT_FAILURE)
    with contextlib.suppress(asyncio.TimeoutError):
        await asyncio.wait_for(leave_failure(), RECONNECT_SECONDS)


async def forward(request, backend, uploads):
    """Forwards a browser's call to the server and its reply to the browser, message by message."""
    if request.content_type not in CONTENT_TYPES:
        raise Rejected(415, f"Content-Type: expected {CONTENT_TYPES[1]}, got "
                            f"{shown(request.content_type)}")
    metadata, seconds = metadata_of(request.headers), timeout_of(request.headers)
    response = web.StreamResponse(headers={
        **HEADERS, "Content-Type": CONTENT_TYPES[1],
        "X-Accel-Buffering": "no"})  # a proxy must pass frames on immediately
    call = None
    try:
        async with uploads.message(request) as body:
            refused = why_refused(body.read(FRAME_BYTES), body)
            if refused is None:
                await reconnected(backend.channel)
                # A stream of one message is the same on the wire as a unary request, but its memory
                # is freed once it has been sent instead of at the call's end.
                call = backend.channel.stream_stream(request.path)(timeout=seconds, metadata=metadata)
                await send(call, body.read())
        await response.prepare(request)
        if refused is not None:
            await response.write(trailers(grpc.StatusCode.INVALID_ARGUMENT, refused, ()))
            return response
        while (message := await next_message(call)) is not None:
            await response.write(frame(0, message))
        await response.write(trailers(*await end_of(call, backend)))
        return response
    finally:
        if call is not None:
            call.cancel()  # if the browser disconnected; otherwise no effect


async def send(call, message):
    """Sends the only message of a call. If this fails, the call's status has the reason."""
    try:
        await call.write(message)
        await call.done_writing()
    except (grpc.RpcError, asyncio.InvalidStateError):
        pass


async def next_message(call):
    """Returns the next message of a call; None at its end. The call's status has the reason."""
    try:
        message = await call.read()
    except grpc.RpcError:
        return None
    return None if message is grpc.aio.EOF else message


async def end_of(call, backend):
    """The code, the message and the trailing metadata of a call that has ended. If gRPC had no server
    for it, the message says so to a person."""
    code, message = await call.code(), await call.details() or ""
    metadata = await call.trailing_metadata() or ()
    if code is grpc.StatusCode.UNAVAILABLE and all(key != DETAILS for key, _ in metadata):
        away = duet.retry.describe_unreachable(backend.address, message)
        message = (f"{away[0].upper()}{away[1:]}. Start it with duet-server, or start the gateway "
                   "with another one (--server HOST:PORT).")
    return code, message, metadata


def why_refused(head, body):
    """Returns the error in a request's body, which must be one frame, or None. `head` has already
    been read from it."""
    here = body.tell()
    size = body.seek(0, os.SEEK_END) - here
    body.seek(here)
    if len(head) < FRAME_BYTES:
        return f"body: expected a gRPC-web frame, got {len(head)} bytes"
    if head[0] != 0:
        return "body: expected an uncompressed message, got another frame"
    if int.from_bytes(head[1:], "big") != size:
        return (f"body: expected one frame of {int.from_bytes(head[1:], 'big')} bytes, got "
                f"{size} bytes")
    return None


def timeout_of(headers):
    """The seconds of a call: those that its caller asks for, but at most LONGEST_SECONDS."""
    text = headers.get("grpc-timeout")
    if text is None:
        return LONGEST_SECONDS
    found = TIMEOUT.fullmatch(text)
    if found is None:
        raise Rejected(400, "grpc-timeout: expected at most 8 digits and one of H, M, S, m, u and n, "
                            f"got {shown(text)}")
    return min(int(found[1]) * SECONDS[found[2]], LONGEST_SECONDS)


def metadata_of(headers):
    metadata = tuple((name, headers[name]) for name in PASSED_ON if headers.get(name))
    for name, value in metadata:
        if not PRINTABLE.fullmatch(value):
            raise Rejected(400, f"{name}: expected printable ASCII, got something else")
    return metadata


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
