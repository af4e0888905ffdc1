"""Helpers of the end-to-end tests: programs, a running server, colours."""

import collections
import contextlib
import http.client
import json
import os
import pathlib
import queue
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

from free_ports import free_port, free_ports  # noqa: F401

SOURCE = pathlib.Path(os.environ["DUET_SOURCE_DIR"])
PROGRAMS = pathlib.Path(os.environ["DUET_BIN_DIR"])
SKIPPED = 77  # tells CTest that a test was skipped
# Maximum time to wait for anything, on a busy machine: a defect makes a test fail instead of hang.
RUN_SECONDS = 120
STOP_SECONDS = 60
# Programs built with a sanitizer may use more memory (scripts/sanitizer_options.sh).
SANITIZED = bool(os.environ.get("DUET_SANITIZER"))
MEMORY_FACTOR = 4 if SANITIZED else 1

CLASSES = ("kick", "push", "shake_hands", "hug", "exchange_object", "punch")
JOINTS = ("head neck torso left_shoulder left_elbow left_hand right_shoulder right_elbow right_hand left_hip left_knee "
          "left_foot right_hip right_knee right_foot").split()  # of the model sbu


def sample(name):
    return SOURCE / "samples" / f"{name}.bvh"


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def main():
    unittest.main(verbosity=2)


def run(*command, timeout=RUN_SECONDS, **options):
    """Runs a command to its end; its exit code, standard output and standard error."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          timeout=timeout, check=False, **options)


def duet(*arguments):
    """Runs the client."""
    return run(PROGRAMS / "duet", *arguments)


def page(port, path):
    """A page of an HTTP port of this machine: status and text."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=RUN_SECONDS)
    with contextlib.closing(connection):
        connection.request("GET", path)
        response = connection.getresponse()
        return response.status, response.read().decode()


class Server:
    """A duet-server on a free port, and everything that it logged, or the last `kept_lines` of it.
    `metrics_port` is that of its figures where `metrics` names an address."""

    def __init__(self, *flags, port=0, metrics="", descriptors=None, kept_lines=None,
                 program=PROGRAMS / "duet-server"):
        self.log = [] if kept_lines is None else collections.deque(maxlen=kept_lines)
        self.metrics_port = None
        limit = [] if descriptors is None else ["prlimit", f"--nofile={descriptors}"]
        command = [*limit, program, "--listen", f"127.0.0.1:{port}", "--metrics-listen", metrics,
                   *flags]
        self._process = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        serving = queue.Queue()
        # Reads the whole log, because the server blocks when the pipe is full.
        self._reader = threading.Thread(target=self._read_log, args=(serving,), daemon=True)
        self._reader.start()
        try:
            self.port = serving.get(timeout=RUN_SECONDS)
        except queue.Empty:
            self.port = None
        if self.port is None:
            self.kill()
            raise AssertionError(f"the server did not come to serve: {self.log}")

    @property
    def pid(self):
        return self._process.pid

    @property
    def address(self):
        return f"127.0.0.1:{self.port}"

    def _read_log(self, serving):
        for line in self._process.stdout:
            try:
                entry = json.loads(line)
            except json.JSONDecodeError:
                entry = {"text": line}  # gRPC's own words
            self.log.append(entry)
            if entry.get("event") == "serving":
                self.metrics_port = entry["metrics_port"]
                serving.put(entry["port"])
        serving.put(None)

    def is_alive(self):
        return self._process.poll() is None

    def page(self, path):
        """A page of the metrics port: status and text."""
        return page(self.metrics_port, path)

    def figure(self, pattern):
        """The sum of the figures whose lines begin with a pattern; 0 while there is none."""
        return sum(int(value) for value in re.findall(rf"^{pattern}\S* (\d+)$", self.page("/metrics")[1], re.MULTILINE))

    def events(self, name):
        """The lines of one event, in order."""
        return [entry for entry in list(self.log) if entry.get("event") == name]

    def exit_code(self, wait_seconds=0):
        """The exit code, or minus the signal that ended it; None if it still runs after that time."""
        try:
            return self._process.wait(timeout=wait_seconds)
        except subprocess.TimeoutExpired:
            return None

    def kill(self):
        """Ends the server without warning."""
        self._process.kill()
        self._process.wait(timeout=STOP_SECONDS)
        self._reader.join(timeout=STOP_SECONDS)
        self._process.stdout.close()

    def stop(self):
        """Asks the server to drain; returns its exit code. A crash is an error."""
        self._process.terminate()
        try:
            code = self._process.wait(timeout=STOP_SECONDS)
        finally:
            self.kill()
        if code < 0 and code != -signal.SIGKILL:
            raise AssertionError(f"the server ended with signal {-code}: {list(self.log)[-20:]}")
        return code


def peak_memory(server):
    """The most bytes that a server has had resident."""
    status = pathlib.Path(f"/proc/{server.pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) * 1024


def started(server, method):
    """How many calls of a method have begun."""
    return server.figure(rf'grpc_server_started_total\{{grpc_method="{method}"')


class FolderTest(unittest.TestCase):
    """Tests that share a temporary folder."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)


class ServedTest(FolderTest):
    """Tests that share a server, and a temporary folder."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.server = Server()
        cls.addClassCleanup(cls.server.stop)


def wait_until(happened, what):
    """Polls a condition outside this process."""
    end = time.monotonic() + RUN_SECONDS
    while not happened():
        if time.monotonic() > end:
            raise AssertionError(f"waited in vain: {what}")
        time.sleep(0.05)


def together(jobs):
    """Runs functions concurrently; returns their results in order."""
    results = [None] * len(jobs)

    def run(i):
        results[i] = jobs[i]()
    threads = [threading.Thread(target=run, args=(i,)) for i in range(len(jobs))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return results


@contextlib.contextmanager
def running_server(*flags, **options):
    server = Server(*flags, **options)
    try:
        yield server
    finally:
        server.stop()


def is_leader_orange(red, green, blue):
    return red > 1.25 * green and green > 1.2 * blue and red > 70


def is_follower_teal(red, green, blue):
    return green > 1.4 * red and blue > 1.4 * red and green > 50
