"""The client whose calls wait for their answers. :mod:`duet_motion.aio` has its asynchronous twin."""

from __future__ import annotations

import threading
from types import TracebackType
from typing import Any, Callable, Generator, Iterable, Iterator, List, Optional, Type, TypeVar

import grpc

from duet_motion import _channel, batch
from duet_motion._call import Attempts, SynthesisCall
from duet_motion._signature import spelled_out
from duet_motion.errors import CancelledError, DuetError, from_rpc_error
from duet_motion.request import SynthesisRequest, to_selector
from duet_motion.result import (FollowerChunk, ModelDetails, ModelInfo, SynthesisResult,
                         details_from_proto, model_from_proto)
from duet_motion.v1 import synthesis_pb2, synthesis_pb2_grpc

_Answer = TypeVar("_Answer")


class Client(_channel.Connected):
    """Asks a Duet server to answer one person's motion with another's.

    >>> with duet.Client() as client:
    ...     result = client.synthesize(leader, labels={"hug": 1, "push": 0.5}, seed=3)
    >>> result.follower.positions                     # [frames, joints, 3]

    Calls may come from several threads. Connects with the first call. :meth:`close` or ``with``
    closes a client.

    Arguments that are left out come from the environment and the configuration file, as those of
    the program `duet` do: ``DUET_SERVER`` is the address, and the file that ``DUET_CONFIG`` names
    (or ``~/.config/duet/config``) has lines such as ``server = lab:50051``, ``timeout = 300``,
    ``wait = 30``, ``tls-ca = ca.pem`` or ``token-file = token``.

    Args:
        address: ``host:port``, or any gRPC target (``unix:/run/duet.sock``). A name that stands for
            several servers is balanced over all of them. Default: ``localhost:50051``.
        timeout: seconds for a whole call, all its attempts included. Default: 120.
        wait: seconds for which a call tries a server again that cannot be reached (refused
            connections, unknown host names) before it fails, at most ``timeout``. Default: 5. A
            server that answers, even to say that it is loading, is tried until ``timeout``.
        tls: how to encrypt; True: with the system's authorities; False: plain text. Default: plain
            text.
        token: says who calls, as ``authorization: Bearer TOKEN``. Without ``tls`` it goes to this
            machine only. Default: none.
        authority: what calls name as the server they are for, if that is not the address.
        retry: how often a call is attempted, and how long it backs off.
        max_concurrent_calls: how many calls of ``synthesize`` are under way at once, at least 1.
            Further ones wait for their turn in this process, within their timeouts: a server
            refuses more calls than it has room for. Default: 16.

    Raises:
        ValueError: an argument or a setting makes no sense.
        OSError: a file that a setting names cannot be read.
    """

    _grpc = grpc
    _semaphore = threading.Semaphore

    def close(self) -> None:
        """Ends the connection, and every call that is still being answered."""
        self._closed.set()
        self._channel.close()

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.close()

    def list_models(self, *, timeout: Optional[float] = None) -> List[ModelInfo]:
        """Every model version being served, by name, newest version first.

        Args:
            timeout: seconds for the whole call. None: the client's.

        Raises:
            DuetError: the call failed.
        """
        response = self._unary(self._stub.ListModels, synthesis_pb2.ListModelsRequest(), timeout)
        return [model_from_proto(model) for model in response.models]

    def get_model(self, model: str = "", *, timeout: Optional[float] = None) -> ModelDetails:
        """One model version, and the limits that a request to it must keep.

        Args:
            model: ``"sbu"``, ``"sbu@2"`` for a version, ``"sbu:stable"`` for a version label;
                empty: the server's default.
            timeout: seconds for the whole call. None: the client's.

        Raises:
            DuetError: the call failed; ModelNotFoundError where there is no such model.
        """
        request = synthesis_pb2.GetModelRequest(model=to_selector(model))
        return details_from_proto(self._unary(self._stub.GetModel, request, timeout))

    def synthesize_request(self, request: SynthesisRequest) -> SynthesisResult:
        """Waits for the whole follower.

        Args:
            request: what is asked.

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
        """The follower's frames as they arrive.

        Args:
            request: what is asked.
        """
        return self._stream(SynthesisCall(request, self._settings))

    synthesize = spelled_out(synthesize_request, SynthesisRequest, "synthesize")
    stream = spelled_out(stream_request, SynthesisRequest, "stream")

    def synthesize_many(self, requests: Iterable[SynthesisRequest], *,
                        concurrency: int = 4) -> Iterator[batch.Outcome]:
        """Answers many requests, several at a time.

        Outcomes come in the order of the requests, each with a result or with what that call failed
        with: one refusal does not end the others. Give requests ``priority="bulk"``: then they
        yield to interactive calls.

        Args:
            requests: taken from the iterable as they are needed, so that it may be long, or made on
                the way.
            concurrency: the most calls at a time, at least 1.

        Raises:
            ValueError: ``concurrency`` makes no sense.
        """
        return batch.run(lambda request: self.stream_request(request).result(), requests,
                         concurrency)

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
    """The follower's frames as they arrive, in order and each once, also where a call is retried.

    >>> with client.stream(leader, {"kick": 1}) as stream:
    ...     for chunk in stream:
    ...         show(chunk.first_frame, chunk.positions)
    >>> stream.result().unfamiliarity

    Iterating raises :class:`duet_motion.DuetError` where the call fails. Leaving ``with`` early, or
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
        """Ends the call, from any thread; whoever waits for its chunks or its result gets a
        CancelledError. A result that is whole already stays."""
        self._cancelled.set()
        self._cancel_stream()

    def result(self) -> SynthesisResult:
        """The whole follower: waits for the chunks that nobody has taken yet.

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
        """One stream from its first message to its end; what it ended with."""
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
            responses.cancel()  # of no effect where the stream is at its end
        return None

    def _sleep(self, seconds: float) -> None:
        if seconds > 0:
            _wait(self._channel, seconds, self._cancelled)


def _wait(channel: grpc.Channel, seconds: float, ended: threading.Event) -> None:
    """Waits, and looks after a lost connection meanwhile: between calls nobody else does. A question
    about the server's health waits for the connection; what it is answered is of no interest."""
    try:
        probe = channel.unary_unary("/grpc.health.v1.Health/Check").future(
            b"", timeout=seconds, wait_for_ready=True)
    except ValueError:  # the channel was closed meanwhile, which the caller looks at
        return
    ended.wait(seconds)
    probe.cancel()
