"""Faults from outside, against the real programs: a full disk, a client that is killed, a thousand
connections that say nothing, a flood of resets. docs/testing_faults.md says which test plays which."""

import contextlib
import os
import pathlib
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

import http2_client as http2
import reset_flood
import tools
from hostile_client_test import SYNTHESIZE, ended, get, handled, in_flight, small_request

SILENT = 1000
FLOOD = 5000
# Of a stream of 300 frames; less than they take, so that the call cannot come to its end.
WINDOW_BYTES = 4096

# A client that begins to read an answer, says so, and waits to be killed.
READER = """
import sys
import http2_client as http2
connection = http2.Connection(int(sys.argv[1]), window=int(sys.argv[2]))
connection.open(sys.argv[3], open(sys.argv[4], "rb").read())
for kind, _, _, payload in connection.frames():
    if kind == http2.DATA and payload:
        print("reading", flush=True)
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def limit_files():
    """Files take no more than this, as if the disk were full; SIGXFSZ would end the process."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, resource.RLIM_INFINITY))


def descriptors(server):
    return len(os.listdir(f"/proc/{server.pid}/fd"))


class FaultsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def serve(self, *flags, **options):
        server = tools.Server(*flags, metrics="127.0.0.1:0", **options)
        self.addCleanup(server.stop)
        return server

    def synthesize(self, address, out, **options):
        return tools.run(tools.PROGRAMS / "duet", "synthesize", "--leader", tools.sample("punch"),
                         "--label", "punch=1", "--out", out, "--server", address,
                         "--timeout", tools.RUN_SECONDS, **options)

    def assert_others_are_answered(self, address):
        result = self.synthesize(address, self.folder / "other.npy")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_log_on_a_full_disk_stops_nothing(self):
        port = free_port()
        with open("/dev/full", "w", encoding="utf-8") as full:
            server = subprocess.Popen(
                [str(tools.PROGRAMS / "duet-server"), "--listen", f"127.0.0.1:{port}",
                 "--metrics-listen", ""], stdout=full, stderr=full)
        with contextlib.ExitStack() as stack:
            stack.callback(server.wait)
            stack.callback(server.kill)
            for _ in range(3):
                self.assert_others_are_answered(f"127.0.0.1:{port}")
            server.terminate()
            self.assertEqual(server.wait(timeout=tools.STOP_SECONDS), 0)

    def test_an_answer_that_does_not_fit_leaves_no_part_of_itself(self):
        server = self.serve()
        for name in ("pair.npy", "pair.html", "pair.glb"):
            result = self.synthesize(server.address, self.folder / name, preexec_fn=limit_files)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn(name, result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assert_others_are_answered(server.address)

    def test_a_client_that_is_killed_gives_its_place_back(self):
        server = self.serve()
        request = self.folder / "request"
        request.write_bytes(small_request(self.folder, frames=300))
        reader = subprocess.Popen(
            [sys.executable, "-c", READER, str(server.port), str(WINDOW_BYTES), SYNTHESIZE,
             str(request)],
            stdout=subprocess.PIPE, text=True,
            env={**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent)})
        with reader:
            self.assertEqual(reader.stdout.readline(), "reading\n")
            self.assertEqual(in_flight(server), 1)
            reader.kill()
        tools.wait_until(lambda: ended(server), "its call is over")
        self.assertEqual(ended(server)[0][0], "CANCELLED")
        self.assertEqual(in_flight(server), 0)
        self.assert_others_are_answered(server.address)

    def test_a_thousand_silent_connections_hold_up_nobody(self):
        most = resource.getrlimit(resource.RLIMIT_NOFILE)
        if most[1] != resource.RLIM_INFINITY and most[1] < 2 * SILENT:
            self.skipTest("needs more descriptors")
        resource.setrlimit(resource.RLIMIT_NOFILE, (2 * SILENT, most[1]))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, most)
        server = self.serve(descriptors=2 * SILENT)
        before = descriptors(server)
        with contextlib.ExitStack() as stack:
            # Nothing at all, half a preface, a preface and no more.
            for i in range(SILENT):
                silent = stack.enter_context(
                    socket.create_connection(("127.0.0.1", server.port), tools.RUN_SECONDS))
                silent.sendall(http2.PREFACE[:(0, 12, 24)[i % 3]])
            tools.wait_until(lambda: descriptors(server) >= before + SILENT, "all are there")
            self.assert_others_are_answered(server.address)
            self.assertEqual(get(server, "/healthz")[0], 200)
            self.assertEqual(get(server, "/readyz")[0], 200)
        tools.wait_until(lambda: descriptors(server) < before + SILENT // 10, "they are closed")

    def test_a_flood_of_resets_leaves_nothing_behind(self):
        server = self.serve()
        self.assertGreater(reset_flood.flood(server.port, False, FLOOD), 0)
        tools.wait_until(lambda: in_flight(server) == 0, "every call is over")
        self.assertLessEqual(set(handled(server)), {"Canceled", "ResourceExhausted"})
        self.assert_others_are_answered(server.address)


if __name__ == "__main__":
    tools.main()
