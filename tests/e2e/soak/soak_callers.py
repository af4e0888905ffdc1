"""The callers of soak.py."""

import collections
import contextlib
import random
import secrets
import threading
import time
import traceback

import grpc

import soak_requests

LONG_DEADLINE = 600.0  # seconds; a call that waits this long was lost, however busy the machine is


class Gate:
    """Admits callers while it is open. Closing it waits until every caller has left."""

    def __init__(self):
        self._changed, self._open, self._inside, self.over = threading.Condition(), False, 0, False

    def set(self, is_open):
        with self._changed:
            self._open = is_open
            self._changed.notify_all()
            self._changed.wait_for(lambda: is_open or self._inside == 0)

    def end(self):
        with self._changed:
            self.over = True
            self._changed.notify_all()

    @contextlib.contextmanager
    def inside(self):
        """Waits until the gate is open. Yields False after the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._open or self.over)
            self._inside += 1
        try:
            yield not self.over
        finally:
            with self._changed:
                self._inside -= 1
                self._changed.notify_all()


class Callers:
    """Callers of every kind, each in a thread of its own."""

    # Kind -> its relative frequency, and the statuses that its calls may have. A call may also end
    # before it is cancelled or expires.
    KINDS = {
        "short clip": (40, {"OK", "RESOURCE_EXHAUSTED"}),
        "long clip": (8, {"OK", "RESOURCE_EXHAUSTED"}),
        "bulk clip": (8, {"OK", "RESOURCE_EXHAUSTED"}),
        "labelled version": (8, {"OK", "RESOURCE_EXHAUSTED"}),
        "version that comes and goes": (8, {"OK", "NOT_FOUND", "RESOURCE_EXHAUSTED"}),
        "large request": (1, {"OK", "RESOURCE_EXHAUSTED", "INVALID_ARGUMENT"}),
        "cancelled at once": (8, {"CANCELLED"}),
        "cancelled in the middle": (8, {"CANCELLED", "OK", "RESOURCE_EXHAUSTED"}),
        "connection closed in the middle": (4, {"CANCELLED", "OK", "RESOURCE_EXHAUSTED"}),
        "deadline of 5 ms": (8, {"DEADLINE_EXCEEDED", "OK", "RESOURCE_EXHAUSTED"}),
        "deadline of 50 ms": (8, {"DEADLINE_EXCEEDED", "OK", "RESOURCE_EXHAUSTED"}),
        "bytes that are no request": (6, {"INVALID_ARGUMENT"}),
        "unknown class": (6, {"INVALID_ARGUMENT"}),
        "joint that is no number": (6, {"INVALID_ARGUMENT"}),
        "unknown model": (6, {"NOT_FOUND"}),
        "wrong token": (6, {"UNAUTHENTICATED"}),
        "no token": (6, {"UNAUTHENTICATED"}),
        "list of models": (10, {"OK"}),
        "new connection": (6, {"OK", "RESOURCE_EXHAUSTED"}),
    }

    def __init__(self, server, protos, callers, seed):
        self.server, self.protos = server, protos
        self.gate = Gate()
        self.token = server.tokens["farm"]
        self.ended = collections.Counter()  # (kind, code)
        self.lost, self.unexpected = [], collections.Counter()
        self._lock = threading.Lock()
        self._requests = self._make_requests()
        self._threads = [threading.Thread(target=self._run, args=(random.Random(f"{seed} {i}"),))
                         for i in range(callers)]
        for thread in self._threads:
            thread.start()

    def end(self):
        self.gate.end()
        for thread in self._threads:
            thread.join()

    def _make_requests(self):
        def request(frames=46, change=None):
            message = self.protos[1].SynthesizeRequest.FromString(
                soak_requests.sample_request(self.protos, frames))
            if change:
                change(message)
            return message.SerializeToString()

        def select(**selector):
            return lambda message: message.model.MergeFrom(type(message.model)(**selector))

        def spoil(message):
            message.leader.positions[7] = float("nan")
        bulk = self.protos[1].PRIORITY_BULK
        return {
            "short": request(), "long": request(900),
            "bulk": request(200, lambda message: setattr(message, "priority", bulk)),
            "labelled": request(46, select(name="sbu", version_label="stable")),
            "version": request(46, select(name="sbu", version=2)),
            "model": request(46, select(name="nobody")),
            "large": soak_requests.sample_request(self.protos, 36000, rate=240.0),
            "class": request(46, lambda message: setattr(
                message.label_vector.weights[0], "interaction_class", "levitate")),
            "nan": request(46, spoil),
        }

    def _run(self, chance):
        channel = self.server.channel()
        kinds, weights = zip(*((kind, weight) for kind, (weight, _) in self.KINDS.items()))
        while True:
            with self.gate.inside() as goes_on:
                if not goes_on:
                    break
                kind = chance.choices(kinds, weights)[0]
                try:
                    self._count(kind, self._play(kind, channel, chance))
                except Exception:  # pylint: disable=broad-except
                    self._lose(kind, traceback.format_exc())
            time.sleep(chance.expovariate(1 / 0.02))
        channel.close()

    def _count(self, kind, code):
        with self._lock:
            self.ended[kind, code] += 1
            if code not in self.KINDS[kind][1]:
                self.unexpected[kind, code] += 1

    def _lose(self, kind, why):
        with self._lock:
            self.lost.append(f"{kind}: {why}")

    def _metadata(self, token=None):
        return (("authorization", f"Bearer {token or self.token}"),)

    def _play(self, kind, channel, chance):
        """Makes a call of a kind and returns its status."""
        sent = {"long clip": "long", "bulk clip": "bulk", "labelled version": "labelled",
                "version that comes and goes": "version", "large request": "large",
                "unknown class": "class", "joint that is no number": "nan",
                "unknown model": "model"}.get(kind, "short")
        request = self._requests[sent]
        if kind == "bytes that are no request":
            request = chance.randbytes(chance.randrange(1, 2000))
            request = b"\x0a\xff\xff" + request  # a field longer than the message
        if kind == "list of models":
            return self._end_of(kind, channel.unary_stream(soak_requests.LIST_MODELS)(
                b"", timeout=LONG_DEADLINE, metadata=self._metadata()), whole=False)
        if kind in ("new connection", "connection closed in the middle"):
            with self.server.channel() as own:
                stream = own.unary_stream(soak_requests.SYNTHESIZE)(
                    request if kind == "new connection" else self._requests["long"],
                    timeout=LONG_DEADLINE, metadata=self._metadata())
                if kind == "new connection":
                    return self._end_of(kind, stream)
                with contextlib.suppress(grpc.RpcError, StopIteration):
                    next(stream)
            return self._end_of(kind, stream, whole=False)
        metadata = {"wrong token": self._metadata(secrets.token_hex(32)),
                    "no token": None}.get(kind, self._metadata())
        timeout = {"deadline of 5 ms": 0.005, "deadline of 50 ms": 0.05}.get(kind, LONG_DEADLINE)
        if kind == "cancelled in the middle":
            request = self._requests["long"]
        stream = channel.unary_stream(soak_requests.SYNTHESIZE)(request, timeout=timeout,
                                                          metadata=metadata)
        if kind == "cancelled at once":
            stream.cancel()
        if kind == "cancelled in the middle":
            with contextlib.suppress(grpc.RpcError, StopIteration):
                next(stream)
            stream.cancel()
        return self._end_of(kind, stream, whole=not kind.startswith("cancelled"))

    def _end_of(self, kind, stream, whole=True):
        """Reads a reply to its end. A call is lost if it reaches the long deadline, or if it ends
        with OK before all its frames."""
        expected = received = 0
        try:
            for message in stream:
                if whole:
                    response = self.protos[1].SynthesizeResponse.FromString(message)
                    expected = expected or response.header.frame_count
                    received += response.chunk.frame_count
        except grpc.RpcError as error:
            code = error.code().name
            if code == "DEADLINE_EXCEEDED" and not kind.startswith("deadline"):
                self._lose(kind, f"no end within {LONG_DEADLINE} s")
            return code
        if whole and (received == 0 or received != expected):
            self._lose(kind, f"expected {expected} frames, got {received}")
        return "OK"
