"""The blocking client. :mod:`duet_motion.aio` has the asyncio version."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Any, Callable, Generator, Iterator, List, Optional, Type, TypeVar

import grpc

from duet_motion import _channel
from duet_motion._call import Attempts, SynthesisCall
from duet_motion._signature import spelled_out
from duet_motion.errors import CancelledError, DuetError, from_rpc_error
from duet_motion.request import SynthesisRequest, to_selector
from duet_motion.result import (FollowerChunk, ModelDetails, ModelInfo, SynthesisResult,
                         details_from_proto, model_from_proto)
from duet_motion.v1 import synthesis_pb2, synthesis_pb2_grpc

_Answer = TypeVar("_Answer")


class Client(_channel.Connected):
    """Calls a Duet server to synthesise the second person of an interaction.

    >>> with duet.Client() as client:
    ...     result = client.synthesize(leader, labels={"hug": 1, "push": 0.5}, seed=3)
    >>> result.follower.positions                     # [frames, joints, 3]

    Safe to share between threads. The first call connects. :meth:`close` or ``with`` closes a
    client.

    Omitted arguments are read from the environment, as the program `duet` does: ``DUET_SERVER`` is
    the address, and ``DUET_TIMEOUT``, ``DUET_WAIT``, ``DUET_TLS_CA``, ``DUET_TOKEN_FILE`` and so on
    stand for the program's flags.

    Args:
        address: ``host:port``, or any gRPC target (``unix:/run/duet.sock``). Calls are
            balanced over all servers that the name resolves to. Default: ``localhost:50051``.
        timeout: seconds for a whole call, including all its attempts. Default: 120.
        wait: seconds to retry a server that cannot be reached (refused connections, unknown host
            names), at most ``timeout``. Default: 5. A server that responds, for example that it is
            loading, is retried until ``timeout``.
        tls: encryption; True: TLS with the system's authorities; False: plain text. Default: plain
            text.
        token: identifies the caller, sent as ``authorization: Bearer TOKEN``. Without ``tls`` it is
            sent only to this machine. Default: none.
        authority: the server name in calls, if it differs from the address.
        retry: number of attempts and backoff.
        max_concurrent_calls: maximum concurrent calls of ``synthesize``, at least 1. Further ones
            wait for their turn in this process, within their timeouts, because a server rejects
            calls above its capacity. Default: 16.

    Raises:
        ValueError: an argument or a setting is invalid.
        OSError: a file that a setting names cannot be read.
    """

    _grpc = grpc
    _semaphore = threading.Semaphore

    def close(self) -> None:
        """Closes the connection and ends every running call."""
        self._closed.set()
        self._channel.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.close()

    def list_models(self, *, timeout: Optional[float] = None) -> List[ModelInfo]:
        """Lists every model version being served, by name, newest version first.

        Args:
            timeout: seconds for the whole call. None: the client's.

        Raises:
            DuetError: the call failed.
        """
        response = self._unary(self._stub.ListModels, synthesis_pb2.ListModelsRequest(), timeout)
        return [model_from_proto(model) for model in response.models]

    def get_model(self, model: str = "", *, timeout: Optional[float] = None) -> ModelDetails:
        """Returns one model version and its request limits.

        Args:
            model: ``"sbu"``, ``"sbu@3"`` for a version, ``"sbu:stable"`` for a version label;
                empty: the server's default.
            timeout: seconds for the whole call. None: the client's.

        Raises:
            DuetError: the call failed; ModelNotFoundError if there is no such model.
        """
        request = synthesis_pb2.GetModelRequest(model=to_selector(model))
        return details_from_proto(self._unary(self._stub.GetModel, request, timeout))

    def synthesize_request(self, request: SynthesisRequest) -> SynthesisResult:
        """Returns the whole follower.

        Args:
            request: the request.

        Raises:
            DuetError: the call failed.
        """
        call = SynthesisCall(request, self._settings)
        if not self._turns.acquire(timeout=call.attempts.seconds_left()):
            raise call.no_turn(self._max_concurrent_calls)
        try:
            return self._stream(call).result()
        finally:
            self._turns.release()

    def stream_request(self, request: SynthesisRequest) -> SynthesisStream:
        """Streams the follower's frames as they arrive.

        Args:
            request: the request.
        """
        return self._stream(SynthesisCall(request, self._settings))

    synthesize = spelled_out(synthesize_request, SynthesisRequest, "synthesize")
    stream = spelled_out(stream_request, SynthesisRequest, "stream")

    def _stream(self, call: SynthesisCall) -> SynthesisStream:
        return SynthesisStream(self._stub, self._channel, self._closed, call)

    def _unary(self, method: Any, request: Any, timeout: Optional[float]) -> Any:
        attempts = Attempts(self._settings, timeout)
        while True:
            _channel.check_open(self._closed)
            try:
                return method(request, timeout=attempts.begin(), metadata=attempts.metadata)
            except grpc.RpcError as error:
                _channel.check_open(self._closed)
                wait = attempts.wait_after(from_rpc_error(error))
            _wait(self._channel, wait, self._closed)


class SynthesisStream(Iterator[FollowerChunk]):
    """The follower's frames as they arrive, in order and each once, also if the call is retried.

    >>> with client.stream(leader, {"kick": 1}) as stream:
    ...     for chunk in stream:
    ...         show(chunk.first_frame, chunk.positions)
    >>> stream.result().unfamiliarity

    Iterating raises :class:`duet_motion.DuetError` if the call fails. Leaving ``with`` early, or
    :meth:`cancel` (from any thread), ends the call.
    """

    def __init__(self, stub: synthesis_pb2_grpc.MotionSynthesisStub, channel: grpc.Channel,
                 closed: threading.Event, call: SynthesisCall) -> None:
        self._stub, self._channel, self._closed, self._call = stub, channel, closed, call
        self._cancelled = threading.Event()
        self._cancel_stream: Callable[[], Any] = lambda: None
        self._result: Optional[SynthesisResult] = None
        self._frames = self._receive()

    def __iter__(self) -> SynthesisStream:
        return self

    def __next__(self) -> FollowerChunk:
        return next(self._frames)

    def __enter__(self) -> SynthesisStream:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.cancel()

    def cancel(self) -> None:
        """Ends the call, from any thread. A thread that waits for its chunks or its result gets a
        CancelledError; a complete result stays available."""
        self._cancelled.set()
        self._cancel_stream()

    def result(self) -> SynthesisResult:
        """Returns the whole follower, after waiting for the chunks that have not been taken yet.

        Raises:
            DuetError: the call failed.
        """
        for _ in self._frames:
            pass
        if self._result is None:
            raise CancelledError(grpc.StatusCode.CANCELLED, "the stream ended before its result")
        return self._result

    def _receive(self) -> Generator[FollowerChunk, None, None]:
        wait: Optional[float] = 0.0
        while wait is not None:
            self._sleep(wait)
            _channel.check_open(self._closed)
            error = yield from self._attempt()
            if error is not None and self._cancelled.is_set():
                raise CancelledError(grpc.StatusCode.CANCELLED, "the call was cancelled")
            if error is not None:
                _channel.check_open(self._closed)
            wait = self._call.wait_after(error)
        self._result = self._call.result()

    def _attempt(self) -> Generator[FollowerChunk, None, Optional[DuetError]]:
        """Receives one stream to its end and returns its error, if any."""
        request, seconds = self._call.begin()
        responses = self._stub.Synthesize(request, timeout=seconds,
                                          metadata=self._call.attempts.metadata)
        self._cancel_stream = responses.cancel
        if self._cancelled.is_set():
            responses.cancel()
        try:
            for response in responses:
                chunk = self._call.accept(response)
                if chunk is not None:
                    yield chunk
        except grpc.RpcError as error:
            return from_rpc_error(error)
        finally:
            responses.cancel()  # no effect if the stream has ended
        return None

    def _sleep(self, seconds: float) -> None:
        if seconds > 0:
            _wait(self._channel, seconds, self._cancelled)


def _wait(channel: grpc.Channel, seconds: float, ended: threading.Event) -> None:
    """Waits, and reconnects a lost connection meanwhile, which gRPC does only during a call. A
    health check waits for the connection; its result is ignored."""
    try:
        probe = channel.unary_unary("/grpc.health.v1.Health/Check").future(
            b"", timeout=seconds, wait_for_ready=True)
    except ValueError:  # the channel was closed meanwhile; the caller checks this
        return
    ended.wait(seconds)
    probe.cancel()
