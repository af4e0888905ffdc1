"""The asyncio version of :mod:`duet_motion.client`: the same methods, and live sessions.

>>> async with duet.aio.Client("localhost:50051") as client:
...     result = await client.synthesize(leader, labels={"hug": 1})
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
from types import TracebackType
from typing import (Any, AsyncGenerator, AsyncIterator, Callable, Coroutine, List, Optional,
                    Type)

import grpc
import grpc.aio

from duet_motion import _channel
from duet_motion import client as blocking
from duet_motion._call import Attempts, SynthesisCall
from duet_motion._live_call import LiveCall
from duet_motion._session import LiveSession
from duet_motion._signature import spelled_out
from duet_motion.errors import CancelledError, DuetError, from_rpc_error
from duet_motion.live import LiveRequest
from duet_motion.request import SynthesisRequest, to_selector
from duet_motion.result import (FollowerChunk, ModelDetails, ModelInfo, SynthesisResult,
                         details_from_proto, model_from_proto)
from duet_motion.v1 import synthesis_pb2, synthesis_pb2_grpc


class Client(_channel.Connected):
    """Calls a Duet server without blocking: the asyncio version of :class:`duet_motion.Client`.

    Create and use a client in one event loop. Cancelling a task that awaits a call ends the call.
    ``asyncio.gather`` over any number of calls is fine: ``max_concurrent_calls`` of them run at a
    time, and the others wait for their turn within their timeouts.

    Args:
        address: the server. :class:`duet_motion.Client` describes all arguments in full.
        timeout: seconds for a whole call.
        wait: seconds to retry a server that cannot be reached.
        tls: encryption.
        token: identifies the caller.
        authority: the server name in calls, if it differs from the address.
        retry: number of attempts and backoff.
        max_concurrent_calls: maximum concurrent calls of ``synthesize``.

    Raises:
        ValueError: an argument or a setting is invalid.
        OSError: a file that a setting names cannot be read.
    """

    _grpc = grpc.aio
    _semaphore = asyncio.Semaphore

    async def close(self) -> None:
        """Closes the connection and ends every running call."""
        self._closed.set()
        await self._channel.close()

    async def __aenter__(self) -> Client:
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        traceback: Optional[TracebackType]) -> None:
        await self.close()

    async def list_models(self, *, timeout: Optional[float] = None) -> List[ModelInfo]:
        response = await self._unary(self._stub.ListModels, synthesis_pb2.ListModelsRequest(),
                                     timeout)
        return [model_from_proto(model) for model in response.models]

    list_models.__doc__ = blocking.Client.list_models.__doc__

    async def get_model(self, model: str = "", *, timeout: Optional[float] = None) -> ModelDetails:
        request = synthesis_pb2.GetModelRequest(model=to_selector(model))
        return details_from_proto(await self._unary(self._stub.GetModel, request, timeout))

    get_model.__doc__ = blocking.Client.get_model.__doc__

    def synthesize_request(
            self, request: SynthesisRequest) -> Coroutine[Any, Any, SynthesisResult]:
        return self._synthesize(SynthesisCall(request, self._settings))

    synthesize_request.__doc__ = blocking.Client.synthesize_request.__doc__

    def stream_request(self, request: SynthesisRequest) -> SynthesisStream:
        return self._stream(SynthesisCall(request, self._settings))

    stream_request.__doc__ = blocking.Client.stream_request.__doc__

    def live_request(self, request: LiveRequest) -> LiveSession:
        """Answers a leader while it still moves. Use the session with ``async with``.

        Args:
            request: the request.
        """
        return LiveSession(self._stub, self._channel, self._closed,
                           LiveCall(request, self._settings), max(self._settings.wait, 1.0))

    synthesize = spelled_out(synthesize_request, SynthesisRequest, "synthesize")
    stream = spelled_out(stream_request, SynthesisRequest, "stream")
    live = spelled_out(live_request, LiveRequest, "live")

    def _stream(self, call: SynthesisCall) -> SynthesisStream:
        return SynthesisStream(self._stub, self._channel, self._closed, call)

    async def _synthesize(self, call: SynthesisCall) -> SynthesisResult:
        turn = asyncio.ensure_future(self._turns.acquire())
        try:
            done, _ = await asyncio.wait({turn}, timeout=call.attempts.seconds_left())
            if not done:
                raise call.no_turn(self._max_concurrent_calls)
            return await self._stream(call).result()
        finally:
            if turn.done() and not turn.cancelled():
                self._turns.release()
            else:
                turn.cancel()

    async def _unary(self, method: Any, request: Any, timeout: Optional[float]) -> Any:
        attempts = Attempts(self._settings, timeout)
        while True:
            _channel.check_open(self._closed)
            try:
                return await method(request, timeout=attempts.begin(), metadata=attempts.metadata)
            except grpc.RpcError as error:
                wait = attempts.wait_after(from_rpc_error(error))
            await _wait(self._channel, wait)


class SynthesisStream(AsyncIterator[FollowerChunk]):
    """The follower's frames as they arrive, in order and each once, also if the call is retried.

    >>> async with client.stream(leader, {"kick": 1}) as stream:
    ...     async for chunk in stream:
    ...         show(chunk.first_frame, chunk.positions)
    >>> (await stream.result()).unfamiliarity

    Iterating raises :class:`duet_motion.DuetError` if the call fails. Leaving ``async with`` early,
    or :meth:`cancel`, ends the call.
    """

    def __init__(self, stub: synthesis_pb2_grpc.MotionSynthesisStub, channel: grpc.aio.Channel,
                 closed: threading.Event, call: SynthesisCall) -> None:
        self._stub, self._channel, self._closed, self._call = stub, channel, closed, call
        self._cancelled = asyncio.Event()
        self._cancel_stream: Callable[[], Any] = lambda: None
        self._result: Optional[SynthesisResult] = None
        self._frames = self._receive()

    def __aiter__(self) -> SynthesisStream:
        return self

    async def __anext__(self) -> FollowerChunk:
        return await self._frames.__anext__()

    async def __aenter__(self) -> SynthesisStream:
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        traceback: Optional[TracebackType]) -> None:
        self.cancel()
        with contextlib.suppress(RuntimeError):  # another task iterates and gets the error
            await self._frames.aclose()

    def cancel(self) -> None:
        """Ends the call. A task that awaits its chunks or its result gets a CancelledError; a
        complete result stays available. Call it in the client's event loop, from any task."""
        self._cancelled.set()
        self._cancel_stream()

    async def result(self) -> SynthesisResult:
        """Returns the whole follower, after awaiting the chunks that have not been taken yet.

        Raises:
            DuetError: the call failed.
        """
        async for _ in self._frames:
            pass
        if self._result is None:
            raise CancelledError(grpc.StatusCode.CANCELLED, "the stream ended before its result")
        return self._result

    async def _receive(self) -> AsyncGenerator[FollowerChunk, None]:
        wait: Optional[float] = 0.0
        while wait is not None:
            await _wait(self._channel, wait, self._cancelled)
            self._check_wanted()
            request, seconds = self._call.begin()
            responses = self._stub.Synthesize(request, timeout=seconds,
                                              metadata=self._call.attempts.metadata)
            self._cancel_stream = responses.cancel
            error: Optional[DuetError] = None
            try:
                async for response in responses:
                    chunk = self._call.accept(response)
                    if chunk is not None:
                        yield chunk
            except grpc.RpcError as broken:
                error = from_rpc_error(broken)
            except asyncio.CancelledError:
                # gRPC raises it for a call that was cancelled, and asyncio for a task.
                self._check_wanted()
                raise
            finally:
                responses.cancel()  # no effect if the stream has ended
            if error is not None:
                self._check_wanted()
            wait = self._call.wait_after(error)
        self._result = self._call.result()

    def _check_wanted(self) -> None:
        _channel.check_open(self._closed)
        if self._cancelled.is_set():
            raise CancelledError(grpc.StatusCode.CANCELLED, "the call was cancelled")


async def _wait(channel: grpc.aio.Channel, seconds: float,
                cancelled: Optional[asyncio.Event] = None) -> None:
    """Waits, unless it is cancelled meanwhile, and reconnects a lost connection."""
    if seconds <= 0:
        return
    channel.get_state(try_to_connect=True)
    if cancelled is None:
        await asyncio.sleep(seconds)
        return
    waiting = asyncio.ensure_future(cancelled.wait())
    try:
        await asyncio.wait({waiting}, timeout=seconds)
    finally:
        waiting.cancel()
