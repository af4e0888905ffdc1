"""Whether the server is well: probes, good calls that have the same answer as ever, memory."""

import http.client
import pathlib
import re
import threading
import time

import http2_client as http2
from fuzzing import Finding
from wire import corpus, protobuf

# Fields of SynthesisSummary that say how long it took.
TIMES = (4, 5)
SUMMARY = 3
REQUEST_ID = "good"
# RESOURCE_EXHAUSTED where places are short; DEADLINE_EXCEEDED and CANCELLED where a request or the
# reading of its answer took longer than the server's short timeouts, on a busy machine. A client of good
# will comes again.
COME_AGAIN = ("8", "4", "1")
SERVING = protobuf.message(f1=1)
# Between two rounds of good calls. Each call has a connection of its own, whose port stays taken for a
# minute after it: without a pause, long runs use up this machine's ports.
PAUSE_SECONDS = 0.02


class Judge:
    """Judges `server` (a tools.Server with metrics). `good` is [("service/method", request), ...]: calls
    that have the same answer for ever, and `memory_mib` the most that the server may come to use."""

    def __init__(self, server, good, memory_mib, patience):
        self._server = server
        self._good = good
        self._memory_mib = memory_mib
        self._patience = patience
        self._expected = {call: self._answer(*call) for call in good}
        self.good_calls = 0
        for method, status in ((call[0], answer[0]) for call, answer in self._expected.items()):
            if status != "0":
                raise Finding(f"{method}: a good call ended with status {status}")

    def check_good_calls(self):
        for call, expected in self._expected.items():
            end = time.monotonic() + self._patience
            answer = self._answer(*call)
            while answer[0] in COME_AGAIN and time.monotonic() < end:
                answer = self._answer(*call)
            if answer != expected:
                raise Finding(f"{call[0]}: a good call was answered differently: "
                              f"{describe(answer)}, not {describe(expected)}")
            self.good_calls += 1

    def check_probes(self):
        """Liveness, readiness and gRPC health. A failed self-check has until the patience ends to be
        followed by a good one."""
        for path in ("/healthz", "/readyz"):
            self._until(lambda path=path: self._page(path)[0] == 200, f"{path} is not 200")
        status, messages = self._answer(f"{corpus.HEALTH}/Check", b"")
        if (status, messages) != ("0", [SERVING]):
            raise Finding(f"health: {status} {messages}, not SERVING")

    def check_memory(self):
        used = self.memory_mib()
        if used > self._memory_mib:
            raise Finding(f"memory: {used} MiB, at most {self._memory_mib} expected")

    def check_no_call_is_left(self):
        """Once nobody asks any more, no call is in flight and nothing waits."""
        def idle():
            gauges = re.findall(r"^duet_(?:calls_in_flight|queued_windows)\S* (\S+)",
                                self._page("/metrics")[1], re.MULTILINE)
            return gauges and not any(map(float, gauges))
        self._until(idle, "calls are in flight though nobody is connected")

    def memory_mib(self):
        status = pathlib.Path(f"/proc/{self._server.pid}/status").read_text(encoding="utf-8")
        found = re.search(r"VmRSS:\s+(\d+)", status)
        if found is None:
            raise Finding("the server has ended")
        return int(found[1]) // 1024

    def _until(self, happened, what):
        end = time.monotonic() + self._patience
        while not happened():
            if time.monotonic() > end:
                raise Finding(what)
            time.sleep(0.05)

    def _page(self, path):
        connection = http.client.HTTPConnection("127.0.0.1", self._server.metrics_port,
                                                timeout=self._patience)
        try:
            connection.request("GET", path)
            response = connection.getresponse()
            return response.status, response.read().decode()
        except (OSError, http.client.HTTPException) as error:
            raise Finding(f"{path}: {error!r}") from error
        finally:
            connection.close()

    def _answer(self, method, request):
        try:
            status, messages = call(self._server.port, method, request, self._patience)
        except OSError as error:
            raise Finding(f"{method}: {error!r}") from error
        if status is None:
            raise Finding(f"{method}: a good call was not answered")
        return status, [without_times(each) for each in messages]


def describe(answer):
    return f"status {answer[0]}, messages of {[len(each) for each in answer[1]]} bytes"


def call(port, method, request, patience):
    """A whole call on a connection of its own: grpc-status (None if there was no end) and messages."""
    connection = http2.Connection(port, patience=patience, window=2**20)
    with connection.socket:
        stream = connection.open("/" + method, request, extra=[("x-request-id", REQUEST_ID)])
        body, end = b"", time.monotonic() + patience
        for kind, flags, of, payload in connection.frames():
            if time.monotonic() > end or of == stream and kind == http2.RST_STREAM:
                break
            if of == stream and kind == http2.DATA:
                body += payload
            if of == stream and flags & http2.END_STREAM:
                return grpc_status(payload), messages_in(body)
    return None, []


def grpc_status(block):
    """The status in a trailer block: a literal, as gRPC writes it, Huffman-coded or not."""
    found = re.search(rb"grpc-status\x01(.)|grpc-status\x02(..)", block)
    if found:
        return (found[1] or found[2]).decode()
    return block.hex()  # indexed or Huffman-coded: compared as it is


def messages_in(body):
    messages = []
    while body:
        length = int.from_bytes(body[1:5], "big")
        messages.append(body[5:5 + length])
        body = body[5 + length:]
    return messages


def without_times(message):
    """A message of Synthesize without the times in its summary; any other as it is."""
    fields = protobuf.parse(message)
    if not fields or fields[0].number != SUMMARY or len(fields) > 1:
        return message
    kept = [field for field in protobuf.parse(fields[0].value) or ()
            if field.number not in TIMES]
    return protobuf.message(f3=protobuf.encode(kept))


class GoodCaller:
    """Makes all good calls, at least once, in a thread beside whatever else goes on. Raises in stop() what
    it found."""

    def __init__(self, judge):
        self._judge = judge
        self._over = threading.Event()
        self._finding = None
        self._thread = threading.Thread(target=self._call, daemon=True)
        self._thread.start()

    def _call(self):
        try:
            self._judge.check_good_calls()
            while not self._over.wait(PAUSE_SECONDS):
                self._judge.check_good_calls()
        except Finding as finding:
            self._finding = finding

    def check(self):
        if self._finding is not None:
            raise self._finding

    def stop(self):
        self._over.set()
        self._thread.join()
        self.check()
