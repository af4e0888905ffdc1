"""The asynchronous twin of :mod:`duet.client`: the same methods, awaited.

>>> async with duet.aio.Client("localhost:50051") as client:
...     result = await client.synthesize(leader, labels={"hug": 1})
"""

from __future__ import annotations

import asyncio
import collections
import threading
from types import TracebackType
from typing import (Any, AsyncGenerator, AsyncIterator, Coroutine, Deque, Iterable, Iterator, List,
                    Optional, Type)

import grpc
import grpc.aio

from duet import _channel, batch
from duet._call import Attempts, SynthesisCall
from duet._signature import spelled_out
from duet.errors import CancelledError, DuetError, from_rpc_error
from duet.request import SynthesisRequest, to_selector
from duet.result import (FollowerChunk, ModelDetails, ModelInfo, SynthesisResult,
                         details_from_proto, model_from_proto)
from duet.v1 import synthesis_pb2, synthesis_pb2_grpc


class Client(_channel.Connected):
    """Asks a Duet server, without waiting: :class:`duet.Client` says what the arguments mean.

    Made and used within one event loop. Cancelling a task that awaits a call ends the call.
    """

    _grpc = grpc.aio

    async def close(self) -> None:
        """Ends the connection, and every call that is still being answered."""
        self._closed.set()
        await self._channel.close()

    async def __aenter__(self) -> Client:
        return self

    async def __aexit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                        traceback: Optional[TracebackType]) -> None:
        await self.close()

    async def list_models(self) -> List[ModelInfo]:
        """Every model version being served, by name, newest version first."""
        response = await self._unary(self._stub.ListModels, synthesis_pb2.ListModelsRequest())
        return [model_from_proto(model) for model in response.models]

    async def get_model(self, model: str = "") -> ModelDetails:
        """One model version (as :attr:`duet.SynthesisRequest.model` names it) and its limits."""
        request = synthesis_pb2.GetModelRequest(model=to_selector(model))
        return details_from_proto(await self._unary(self._stub.GetModel, request))

    def synthesize_request(
            self, request: SynthesisRequest) -> Coroutine[Any, Any, SynthesisResult]:
        """Awaits the whole follower."""
        return self.stream_request(request).result()

    def stream_request(self, request: SynthesisRequest) -> SynthesisStream:
        """The follower's frames as they arrive."""
        return SynthesisStream(self._stub, self._channel, self._closed,
                               SynthesisCall(request, self._settings))

    synthesize = spelled_out(synthesize_request, SynthesisRequest, "synthesize")
    stream = spelled_out(stream_request, SynthesisRequest, "stream")

    def synthesize_many(self, requests: Iterable[SynthesisRequest], *,
                        concurrency: int = 4) -> AsyncIterator[batch.Outcome]:
        """Answers many requests, at most ``concurrency`` of them at a time, as
        :meth:`duet.Client.synthesize_many` does."""
        batch.check_concurrency(concurrency)
        return self._many(iter(requests), concurrency)

    async def _many(self, requests: Iterator[SynthesisRequest],
                    concurrency: int) -> AsyncGenerator[batch.Outcome, None]:
        free = asyncio.Semaphore(concurrency)

        async def outcome(request: SynthesisRequest) -> batch.Outcome:
            async with free:
                try:
                    return batch.Outcome(request, result=await self.synthesize_request(request))
                except DuetError as error:
                    return batch.Outcome(request, error=error)

        waiting: Deque[asyncio.Task[batch.Outcome]] = collections.deque()

        def take(count: int) -> None:
            for _, request in zip(range(count), requests):
                waiting.append(asyncio.ensure_future(outcome(request)))

        try:
            take(batch.ahead(concurrency))
            while waiting:
                done = await waiting[0]
                waiting.popleft()
                take(1)
                yield done
        finally:
            for task in waiting:
                task.cancel()

    async def _unary(self, method: Any, request: Any) -> Any:
        attempts = Attempts(self._settings)
        while True:
            _channel.check_open(self._closed)
            try:
                return await method(request, timeout=attempts.begin(), metadata=attempts.metadata)
            except grpc.RpcError as error:
                wait = attempts.wait_after(from_rpc_error(error))
            await _wait(self._channel, wait)


class SynthesisStream(AsyncIterator[FollowerChunk]):
    """The follower's frames as they arrive, in order and each once, also where a call is retried.

    >>> async with client.stream(leader, {"kick": 1}) as stream:
    ...     async for chunk in stream:
    ...         show(chunk.first_frame, chunk.positions)
    >>> (await stream.result()).unfamiliarity

    Iterating raises :class:`duet.DuetError` where the call fails. Leaving ``async with`` early ends
    the call.
    """

    def __init__(self, stub: synthesis_pb2_grpc.MotionSynthesisStub, channel: grpc.aio.Channel,
                 closed: threading.Event, call: SynthesisCall) -> None:
        self._stub, self._channel, self._closed, self._call = stub, channel, closed, call
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
        await self._frames.aclose()

    async def result(self) -> SynthesisResult:
        """The whole follower: awaits the chunks that nobody has taken yet."""
        async for _ in self._frames:
            pass
        if self._result is None:
            raise CancelledError(grpc.StatusCode.CANCELLED, "the stream ended before its result")
        return self._result

    async def _receive(self) -> AsyncGenerator[FollowerChunk, None]:
        wait: Optional[float] = 0.0
        while wait is not None:
            if wait > 0:
                await _wait(self._channel, wait)
            _channel.check_open(self._closed)
            request, seconds = self._call.begin()
            responses = self._stub.Synthesize(request, timeout=seconds,
                                              metadata=self._call.attempts.metadata)
            error: Optional[DuetError] = None
            try:
                async for response in responses:
                    chunk = self._call.accept(response)
                    if chunk is not None:
                        yield chunk
            except grpc.RpcError as broken:
                error = from_rpc_error(broken)
            finally:
                responses.cancel()  # of no effect where the stream is at its end
            wait = self._call.wait_after(error)
        self._result = self._call.result()


async def _wait(channel: grpc.aio.Channel, seconds: float) -> None:
    """Waits, and has a lost connection tried again meanwhile."""
    channel.get_state(try_to_connect=True)
    await asyncio.sleep(seconds)
