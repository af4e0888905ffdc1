"""Carries MotionSynthesis.SynthesizeLive over a WebSocket, because browsers cannot stream to a
server over gRPC-web.

Binary messages pass through unchanged in both directions, one for one. An empty binary message from
the browser ends the leader. The last message to the browser is text: the call's status as JSON,
{"code": 0, "message": "", "details": base64 of google.rpc.Status, or ""}.
"""

import asyncio
import base64
import contextlib
import json

import aiohttp
import grpc
import grpc.aio
import grpc_web
import serving
from aiohttp import web

METHOD = "/duet.v1.MotionSynthesis/SynthesizeLive"
MAX_SESSIONS = 64
MAX_MESSAGE_BYTES = 2**20     # a start with the history of a resumed session takes most
SILENCE_SECONDS = 30          # between two messages of the browser
PING_SECONDS = 10             # a browser that does not answer a ping is gone
SEND_SECONDS = 10             # for a message to leave for the browser or for the server
CLOSE_SECONDS = 1             # for the browser to answer the end of a session
LONGEST_REASON = 120          # bytes; a limit of RFC 6455
# WebSocket close codes (RFC 6455).
DONE, GOING_AWAY, UNSUPPORTED, POLICY, FAILED = 1000, 1001, 1003, 1008, 1011


class Ended(Exception):
    """The gateway ends a session, with a close code and a message for the browser."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code, self.message = code, message


class LiveSockets:
    """The sessions of a gateway."""

    def __init__(self, backend):
        self._backend = backend
        self._sessions = set()  # the task of each

    async def answer(self, request):
        """Handles a request for a session, until its end."""
        serving.check_upgrade(request)
        if len(self._sessions) >= MAX_SESSIONS:
            raise serving.Rejected(503, f"sessions: expected fewer than {MAX_SESSIONS}, got one "
                                        "more; try again later")
        metadata = grpc_web.metadata_of(request.headers)
        # Without compression, a small message cannot become a large one.
        socket = web.WebSocketResponse(heartbeat=PING_SECONDS, compress=False,
                                       max_msg_size=MAX_MESSAGE_BYTES, timeout=SEND_SECONDS)
        task = asyncio.current_task()
        self._sessions.add(task)
        try:
            try:
                await socket.prepare(request)
            except web.HTTPException as error:
                raise serving.Rejected(400, f"WebSocket: {error.text}") from None
            serving.without_time_limit(request)
            await self._session(request, socket, metadata)
        finally:
            self._sessions.discard(task)
        return socket

    async def close(self):
        """Ends every session, because the gateway stops."""
        for task in list(self._sessions):
            task.cancel()
        if self._sessions:
            await asyncio.wait(self._sessions, timeout=serving.SHUTDOWN_SECONDS)

    async def _session(self, request, socket, metadata):
        call = self._backend.channel.stream_stream(METHOD)(metadata=metadata)
        sending = asyncio.ensure_future(to_server(socket, call))
        receiving = asyncio.ensure_future(to_browser(socket, call, self._backend))
        code, message = FAILED, ""
        try:
            await asyncio.wait({sending, receiving}, return_when=asyncio.FIRST_COMPLETED)
            if not receiving.done():
                sending.result()  # raises, unless the call has ended
            await receiving
            code = DONE
        except Ended as ended:
            code, message = ended.code, ended.message
        except asyncio.CancelledError:
            code, message = GOING_AWAY, "the gateway stops"
            raise
        except ConnectionError:
            if request.transport:
                request.transport.abort()  # the browser is gone, or does not read
        finally:
            for task in (sending, receiving):
                task.cancel()
            call.cancel()
            await asyncio.gather(sending, receiving, return_exceptions=True)
            await close(request, socket, code, message)


async def close(request, socket, code, message):
    """Closes the connection, without waiting for long for a browser that does not read."""
    with contextlib.suppress(ConnectionError, TimeoutError, RuntimeError, asyncio.CancelledError):
        async with asyncio.timeout(CLOSE_SECONDS):
            await socket.close(code=code, message=message.encode()[:LONGEST_REASON])
    if request.transport and request.transport.get_write_buffer_size():
        request.transport.abort()


async def to_server(socket, call):
    """Passes messages on until the call ends. Reads on when the leader has ended, because only a
    socket that is being read answers pings and notices that the browser leaves."""
    has_ended = False
    while True:
        data = await received(socket)
        if has_ended:
            raise Ended(POLICY, "expected nothing after the end of the leader, got a message")
        has_ended = not data
        try:
            async with asyncio.timeout(SEND_SECONDS):
                await (call.write(data) if data else call.done_writing())
        except TimeoutError:
            raise Ended(FAILED, "the server does not read") from None
        except (grpc.RpcError, asyncio.InvalidStateError):
            return  # to_browser reports the call's status


async def received(socket):
    """The next message from the browser, as bytes."""
    try:
        async with asyncio.timeout(SILENCE_SECONDS):
            message = await socket.receive()
    except TimeoutError:
        raise Ended(POLICY, f"expected a message within {SILENCE_SECONDS} s, got none") from None
    if message.type is aiohttp.WSMsgType.BINARY:
        return message.data
    if message.type is aiohttp.WSMsgType.TEXT:
        raise Ended(UNSUPPORTED, "expected binary messages, got text")
    raise ConnectionError("the browser has left")


async def to_browser(socket, call, backend):
    """Passes messages on until the call ends, then its status."""
    while (message := await grpc_web.next_message(call)) is not None:
        await send(socket.send_bytes(message))
    await send(socket.send_str(status_of(*await grpc_web.end_of(call, backend))))


async def send(sending):
    """Waits until a message has been sent. A browser that does not read is taken as gone."""
    try:
        async with asyncio.timeout(SEND_SECONDS):
            await sending
    except TimeoutError:
        raise ConnectionError("the browser does not read") from None


def status_of(code, message, metadata):
    details = b"".join(value for key, value in metadata if key == grpc_web.DETAILS)
    return json.dumps({"code": code.value[0], "message": message,
                       "details": base64.b64encode(details).decode()})
