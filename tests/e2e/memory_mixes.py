"""Mixes of legal calls that use as much of a server's memory as they can, for memory_limit_test.py."""

import contextlib
import threading
import time

import grpc
import http2_client as http2

SYNTHESIZE = "/duet.v1.MotionSynthesis/Synthesize"
MIB = 1 << 20


def channel(port):
    """A connection of its own."""
    return grpc.insecure_channel(f"127.0.0.1:{port}", options=[
        ("grpc.use_local_subchannel_pool", 1), ("grpc.max_send_message_length", -1),
        ("grpc.max_receive_message_length", -1)])


class Tally:
    """What became of the attempts of a mix."""

    def __init__(self):
        self._lock = threading.Lock()
        self.codes = {}
        self.unexplained = []  # refusals without a time to come back

    def add(self, code, details="", explained=True):
        with self._lock:
            self.codes[code] = self.codes.get(code, 0) + 1
            if not explained:
                self.unexplained.append(f"{code}: {details}")

    def __str__(self):
        return ", ".join(f"{count} {code}" for code, count in sorted(self.codes.items()))


def ask(stub, payload, tally, timeout):
    """One attempt, read to its end. True unless it may be made again."""
    try:
        for _ in stub(payload, timeout=timeout):
            pass
    except grpc.RpcError as error:
        trailers = dict(error.trailing_metadata() or ())
        retry = b"google.rpc.RetryInfo" in trailers.get("grpc-status-details-bin", b"")
        code = error.code().name
        tally.add(code, error.details(), retry)
        return code not in ("RESOURCE_EXHAUSTED", "UNAVAILABLE")
    tally.add("OK")
    return True


def until_answered(port, payload, callers, seconds, each=1, alive=lambda: True):
    """`callers` connections that make `each` calls, all at once, and repeat those that are refused
    while the server is alive."""
    tally = Tally()
    end = time.monotonic() + seconds

    def run():
        with channel(port) as connection:
            stub = connection.unary_stream(SYNTHESIZE)
            for _ in range(each):
                while not ask(stub, payload, tally, seconds) and alive() and time.monotonic() < end:
                    time.sleep(1)  # what RetryInfo says
    threads = [threading.Thread(target=run) for _ in range(callers)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return tally


class StalledReaders:
    """Connections whose calls are never read: every call stops at what its window takes."""

    def __init__(self, port, payload, connections, calls):
        self.connections = []
        for _ in range(connections):
            connection = http2.Connection(port, window=0)
            self.connections.append(connection)
            threading.Thread(target=self._drain, args=(connection, payload, calls),
                             daemon=True).start()

    @staticmethod
    def _drain(connection, payload, calls):
        with contextlib.suppress(OSError, StopIteration):
            for _ in range(calls):
                connection.open(SYNTHESIZE, payload)
            for _ in connection.frames():
                pass

    def close(self):
        for connection in self.connections:
            connection.close()


class SlowUploads:
    """Connections that send all of a request except its last byte, and go on holding it."""

    def __init__(self, port, size, connections):
        self.connections = [http2.Connection(port) for _ in range(connections)]
        for connection in self.connections:
            threading.Thread(target=self._send, args=(connection, size), daemon=True).start()

    @staticmethod
    def _send(connection, size):
        with contextlib.suppress(OSError):
            connection.upload(SYNTHESIZE, bytes(size), end=False)

    def close(self):
        for connection in self.connections:
            connection.close()
