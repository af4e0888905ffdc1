"""Faults from outside, against the real programs: a full disk, a client that is killed, a thousand
connections that say nothing, a flood of resets. docs/testing_faults.md says which test plays which."""

import contextlib
import json
import os
import pathlib
import re
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
from hostile_client_test import SYNTHESIZE, ended, handled, in_flight
from wire.corpus import standing

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


def survive_full_files():
    """Files at their limit are as if the disk were full; SIGXFSZ would end the process."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


def limit_files():
    """Files take no more than this."""
    survive_full_files()
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, resource.RLIM_INFINITY))


class LoggingServer:
    """A duet-server that logs to a file, of which it may write so much as a test lets it."""

    def __init__(self, path):
        self._path = path
        with path.open("wb") as log:
            self._process = subprocess.Popen(
                [str(tools.PROGRAMS / "duet-server"), "--listen", "127.0.0.1:0",
                 "--metrics-listen", "127.0.0.1:0"],
                stdout=log, stderr=log, preexec_fn=survive_full_files)
        tools.wait_until(lambda: self.events("serving"), "it serves")
        serving = self.events("serving")[0]
        self.address = f"127.0.0.1:{serving['port']}"
        self.metrics_port = serving["metrics_port"]

    def lines(self):
        """What it has written in whole, each line as an object, or as bytes where it is none."""
        def parsed(line):
            try:
                return json.loads(line)
            except json.JSONDecodeError:
                return line
        return [parsed(line) for line in self._path.read_bytes().split(b"\n")[:-1]]

    def events(self, name):
        return [line for line in self.lines() if isinstance(line, dict) and line["event"] == name]

    def torn_lines(self):
        return [line for line in self.lines() if isinstance(line, bytes)]

    def leave_room(self, size):
        """Lets its files grow by so many bytes, or without limit."""
        most = resource.RLIM_INFINITY if size is None else self._path.stat().st_size + size
        resource.prlimit(self._process.pid, resource.RLIMIT_FSIZE, (most, resource.RLIM_INFINITY))

    def lost_lines(self):
        return int(re.search(r"^duet_log_lines_dropped_total (\d+)", tools.page(self.metrics_port, "/metrics")[1],
                             re.MULTILINE)[1])

    def stop(self):
        self._process.terminate()
        try:
            return self._process.wait(timeout=tools.STOP_SECONDS)
        finally:
            self.kill()

    def kill(self):
        self._process.kill()
        self._process.wait(timeout=tools.STOP_SECONDS)


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

    def test_full_disk_of_the_log_stops_no_call(self):
        server = LoggingServer(self.folder / "log")
        self.addCleanup(server.kill)
        part = 20  # bytes of a line
        server.leave_room(part)
        calls = 3
        for _ in range(calls):
            self.assert_others_are_answered(server.address)
        tools.wait_until(lambda: server.lost_lines() >= calls, "each call's line is lost")
        self.assertEqual(server.events("call"), [])
        server.leave_room(None)
        self.assert_others_are_answered(server.address)
        tools.wait_until(lambda: server.events("call"), "lines are written again")
        # What came later stands on lines of its own.
        self.assertEqual([len(line) for line in server.torn_lines()], [part])
        self.assertEqual(server.stop(), 0)
        self.assertEqual(len(server.events("stopped")), 1)

    def test_result_on_a_full_disk_leaves_no_partial_file(self):
        server = self.serve()
        for name in ("pair.npy", "pair.html", "pair.glb"):
            result = self.synthesize(server.address, self.folder / name, preexec_fn=limit_files)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn(name, result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assert_others_are_answered(server.address)

    def test_killed_client_releases_its_place(self):
        server = self.serve()
        request = self.folder / "request"
        request.write_bytes(standing(300))
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

    def test_a_thousand_silent_connections_delay_no_call(self):
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
            # On a slow machine the first may be closed before the last is there.
            tools.wait_until(lambda: descriptors(server) >= before + SILENT // 2, "they are there")
            self.assert_others_are_answered(server.address)
            self.assertEqual(server.page("/healthz")[0], 200)
            self.assertEqual(server.page("/readyz")[0], 200)
            tools.wait_until(lambda: descriptors(server) < before + SILENT // 10,
                             "the server closes them")

    def test_flood_of_resets_leaves_no_resources_behind(self):
        server = self.serve()
        self.assertGreater(reset_flood.flood(server.port, False, FLOOD), 0)
        # The server is still at it; while the flood holds its share of places, others are refused.
        tools.wait_until(lambda: self.synthesize(server.address, self.folder / "other.npy")
                         .returncode == 0, "others are answered")
        tools.wait_until(lambda: "Canceled" in handled(server) and in_flight(server) == 0
                         and tools.started(server, "Synthesize") == sum(handled(server).values()),
                         "every call is over")
        self.assertLessEqual(set(handled(server)), {"Canceled", "ResourceExhausted", "OK"})


@unittest.skipUnless((tools.PROGRAMS / "duet-train").exists(), "programs with LibTorch are not built")
class NoProcTest(unittest.TestCase):
    """LibTorch reads the processor from /proc, which a container may lack."""

    WITHOUT_PROC = ("unshare", "--map-root-user", "--mount", "sh", "-c",
                    'mount -t tmpfs none /proc && exec "$0" "$@"')

    def setUp(self):
        result = tools.run(*self.WITHOUT_PROC, "true")
        if result.returncode != 0:
            self.skipTest(f"cannot hide /proc here: {result.stderr}")

    def check(self, *command):
        """A command ends with an error in words, not with an exception."""
        result = tools.run(*self.WITHOUT_PROC, tools.PROGRAMS / command[0], *command[1:])
        self.assertIn(f"\n{command[0]}: ", f"\n{result.stderr}")
        self.assertIn("LibTorch reads /proc/cpuinfo: is it there?", result.stderr)
        self.assertNotIn("frame #", result.stderr)
        self.assertEqual(result.returncode, 1)

    def test_training_and_evaluation_report_missing_files(self):
        with tempfile.TemporaryDirectory() as folder:
            self.check("duet-train", "--data", folder, "--out", folder)
            self.check("duet-eval", "folds", "--data", folder)


if __name__ == "__main__":
    tools.main()
