"""Clients that keep to the protocol and mean no good, against the real server: it stays small, and
answers others."""

import re
import socket
import subprocess
import tempfile
import threading
import unittest

import http2_client as http2
import tools
from wire.corpus import standing

SYNTHESIZE = "/duet.v1.MotionSynthesis/Synthesize"
HOSTILE = "127.0.0.2"


def in_flight(server):
    return server.figure(r'duet_calls_in_flight\{method="Synthesize"\}')


def ended(server):
    """Codes and messages of the Synthesize calls that are over."""
    return [(entry["code"], entry.get("message", "")) for entry in list(server.log)
            if entry.get("event") == "call" and entry["method"] == "Synthesize"]


def handled(server):
    """How many Synthesize calls are over, by code. The log leaves refusals out where there are many."""
    lines = re.findall(r'grpc_server_handled_total\{grpc_code="(\w+)",grpc_method="Synthesize".*\} '
                       r"(\d+)", server.page("/metrics")[1])
    return {code: int(count) for code, count in lines}


class HostileClientTest(unittest.TestCase):
    def serve(self, *flags, **options):
        server = tools.Server(*flags, metrics="127.0.0.1:0", **options)
        self.addCleanup(server.stop)
        return server

    def connect(self, server, **options):
        connection = http2.Connection(server.port, source=HOSTILE, **options)
        self.addCleanup(connection.close)
        return connection

    def assert_others_are_answered(self, server):
        result = tools.duet("models", "--server", server.address)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_requests_of_tiny_messages_stay_small(self):
        server = self.serve()
        # 16 million empty keyframes' worth of bytes: over 1 GB each, if they were parsed.
        bomb = b"\x22\x02\x12\x00" * (31 * (1 << 20) // 4)
        senders = [threading.Thread(target=self.connect(server).upload, args=(SYNTHESIZE, bomb)) for _ in range(2)]
        for sender in senders:
            sender.start()
        self.assert_others_are_answered(server)
        for sender in senders:
            sender.join()
        tools.wait_until(lambda: len(ended(server)) == 2, "both have ended")
        for code, message in ended(server):
            self.assertEqual(code, "INVALID_ARGUMENT")
            self.assertIn("label_keyframes: expected at most 524288 values", message)
        self.assertLess(tools.peak_memory(server), 600_000_000 * tools.MEMORY_FACTOR)

    def test_stalled_readers_release_their_places(self):
        server = self.serve("--write-timeout-seconds", "0.5")
        connection = self.connect(server, window=0)
        # Malformed requests end at once: their refusal needs no window. These are good.
        for _ in range(200):
            connection.open(SYNTHESIZE, standing(20))
        self.assert_others_are_answered(server)
        tools.wait_until(lambda: sum(handled(server).values()) == 200, "all have ended")
        # On a slow machine the first have given their places back before the last come.
        self.assertIn("DeadlineExceeded", handled(server))
        self.assertLessEqual(set(handled(server)), {"DeadlineExceeded", "ResourceExhausted"})
        self.assertTrue(any("write_timeout_seconds = 0.5" in text for _, text in ended(server)))
        self.assertEqual(in_flight(server), 0)

    def test_missing_requests_release_their_places(self):
        server = self.serve("--receive-timeout-seconds", "0.5")
        connection = self.connect(server)
        for _ in range(200):
            connection.open(SYNTHESIZE)
        self.assert_others_are_answered(server)
        tools.wait_until(lambda: sum(handled(server).values()) == 200, "all have ended")
        self.assertEqual(in_flight(server), 0)

    def test_silent_sockets_delay_no_metrics_page(self):
        server = self.serve()
        for words in ("", "G", "GET /metr") * 30:
            loiterer = socket.create_connection(("127.0.0.1", server.metrics_port))
            self.addCleanup(loiterer.close)
            loiterer.sendall(words.encode())
        for path in ("/healthz", "/readyz", "/metrics"):
            self.assertEqual(server.page(path)[0], 200)

    def test_dead_listener_is_unhealthy(self):
        server = self.serve("--self-check-seconds", "0.1", descriptors=64)
        self.assertEqual(server.page("/healthz")[0], 200)
        held = []
        self.addCleanup(lambda: [each.close() for each in held])
        for _ in range(80):
            held.append(socket.create_connection(("127.0.0.1", server.port)))
        # With none left, not even its own check has a descriptor.
        tools.wait_until(lambda: any(entry.get("event") == "self_check_failed"
                               for entry in list(server.log)), "its check fails")
        for each in held:
            each.close()
        tools.wait_until(lambda: server.page("/readyz")[0] == 503, "it takes no new calls")
        tools.wait_until(lambda: server.page("/healthz")[0] == 503, "it says so")

    def test_deadline_beyond_the_clocks_range_is_accepted(self):
        server = self.serve()
        connection = self.connect(server)
        connection.open(SYNTHESIZE, standing(20), extra=[("grpc-timeout", "99999999H")])
        for kind, flags, _, _ in connection.frames():
            if kind == http2.HEADERS and flags & http2.END_STREAM:
                break
        tools.wait_until(lambda: ended(server), "the call is logged")
        self.assertEqual(ended(server), [("OK", "")])

    def test_a_call_cancelled_before_its_request_counts_as_cancelled(self):
        server = self.serve()
        connection = self.connect(server)
        stream = connection.open(SYNTHESIZE)
        tools.wait_until(lambda: in_flight(server) == 1, "the call has begun")
        connection.socket.sendall(
            http2.frame(http2.RST_STREAM, 0, stream, (8).to_bytes(4, "big")))
        tools.wait_until(lambda: ended(server), "the call is logged")
        self.assertEqual(ended(server)[0][0], "CANCELLED")


class RestartTest(unittest.TestCase):
    def test_a_call_waits_for_a_server_that_restarts(self):
        server = tools.Server(port=tools.free_port())
        server.kill()
        with tempfile.TemporaryDirectory() as folder:
            call = subprocess.Popen(
                [str(tools.PROGRAMS / "duet"), "synthesize", "--leader", tools.sample("punch"),
                 "--label", "punch=1", "--out", f"{folder}/pair.html", "--server",
                 server.address, "--wait", str(tools.RUN_SECONDS)],
                stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            with call:
                self.assertIn("is not running", call.stderr.readline())
                again = tools.Server(port=server.port)
                self.addCleanup(again.stop)
                _, error = call.communicate(timeout=tools.RUN_SECONDS)
            self.assertEqual(call.returncode, 0, error)


if __name__ == "__main__":
    tools.main()
