"""In a small container no mix of legal calls ends the server: with its default settings it stays below
the limit, refuses what does not fit with a time to come back, and answers it then. The server is told the limit, and
the test compares it with the peak of its resident memory."""

import os
import pathlib
import shutil
import signal
import tempfile
import threading
import unittest

import tools
from wire.corpus import standing

try:
    import memory_mixes as mixes
except ImportError as error:
    tools.skip(f"{error}; install the package python3-grpcio")
if tools.SANITIZED:
    tools.skip("a sanitizer takes several times the memory that the server plans with")

# gRPC's, where more arrived within a tenth of a second than it has memory for ("Transport closed" of a
# call that began on a connection that was just ended so), and of calls that were ended while a message
# was under way: neither can have details.
TRANSPORTS_WORDS = ("GOAWAY received", "RST_STREAM with error code 11", "Connection reset by peer",
                    "Broken pipe", "Transport closed",
                    "while other calls waited for a place or for memory")
LIMIT = 400 * mixes.MIB
SECONDS = 700  # for everything, on a busy machine
LEADER = standing(144000, rate=240, chunk_frames=240)  # ten minutes: 26 MB
CLIP = standing(2400, rate=240, chunk_frames=240)
LABELLED_CLIP = standing(2400, rate=240, chunk_frames=240, keyframes=2400)
SHORT = standing(46)


class Reloads:
    """A repository in which a version comes and goes, which the server is told to read each time."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder) / "models"
        shutil.copytree(tools.SOURCE / "model/embedded", self.folder,
                        ignore=shutil.ignore_patterns("*.txt", "*.md", "*.cc", "*.h", "*.in"))
        self.aside = pathlib.Path(folder) / "aside"
        self._over = threading.Event()
        self._thread = None

    def begin(self, pid):
        self._thread = threading.Thread(target=self._run, args=(pid,))
        self._thread.start()

    def _run(self, pid):
        version = self.folder / "sbu/1"
        while not self._over.wait(0.3):
            source, target = (version, self.aside) if version.exists() else (self.aside, version)
            source.rename(target)
            os.kill(pid, signal.SIGHUP)

    def end(self):
        self._over.set()
        self._thread.join()


class MemoryLimitTest(unittest.TestCase):
    def serve(self, *flags):
        server = tools.Server("--memory-limit-bytes", str(LIMIT), *flags)
        self.addCleanup(server.stop)
        return server

    def assert_within_limit(self, server):
        self.assertTrue(server.is_alive(), "the server has ended")
        peak = tools.peak_memory(server)
        print(f"peak of the resident memory: {peak // 1_000_000} MB of {LIMIT // 1_000_000}")
        self.assertLess(peak, LIMIT)

    def assert_answered(self, tally, count):
        self.assertEqual(tally.codes.pop("OK", 0), count, tally)
        self.assertLessEqual(set(tally.codes), {"RESOURCE_EXHAUSTED", "UNAVAILABLE"})
        own = [text for text in tally.unexplained if not text.endswith(TRANSPORTS_WORDS)]
        self.assertEqual(own, [], "a refusal says when to come back")

    def ask(self, server, payload, callers, **options):
        return mixes.until_answered(server.port, payload, callers, SECONDS, alive=server.is_alive,
                                    **options)

    def test_long_leaders_at_once_are_all_answered(self):
        server = self.serve()
        tally = self.ask(server, LEADER, 16)
        self.assert_within_limit(server)
        self.assert_answered(tally, 16)

    def test_all_loads_together_stay_within_the_limit(self):
        with tempfile.TemporaryDirectory() as folder:
            reloads = Reloads(folder)
            server = self.serve("--model-repository", reloads.folder, "--default-model", "sbu")
            held = [mixes.StalledReaders(server.port, CLIP, connections=4, calls=32),
                    mixes.StalledReaders(server.port, LABELLED_CLIP, connections=4, calls=32),
                    mixes.StalledReaders(server.port, LEADER, connections=4, calls=1),
                    mixes.SlowUploads(server.port, 31 * mixes.MIB, 8),
                    mixes.SlowUploads(server.port, 63 * mixes.MIB, 4)]
            reloads.begin(server.pid)
            tallies = tools.together(
                [lambda: self.ask(server, SHORT, 32, each=5), lambda: self.ask(server, LEADER, 3)])
            reloads.end()
            self.assert_within_limit(server)
            for each in held:
                each.close()
            self.assert_answered(tallies[0], 32 * 5)
            self.assert_answered(tallies[1], 3)

    def test_settings_that_do_not_fit_cause_a_warning(self):
        flags = ["--max-held-bytes", str(512 * mixes.MIB)]
        server = self.serve(*flags)
        tools.wait_until(lambda: server.events("settings_do_not_fit"), "the server warns")
        warning = server.events("settings_do_not_fit")[0]
        self.assertEqual(warning["severity"], "WARNING")
        for words in ("the limit is 419 MB", "536 MB for max_held_bytes"):
            self.assertIn(words, warning["message"])
        checked = tools.run(tools.PROGRAMS / "duet-server", "--memory-limit-bytes", LIMIT, *flags,
                            "--check-config")
        self.assertEqual(checked.returncode, 0, checked.stderr)
        self.assertIn("warning: memory: the settings admit requests that need", checked.stdout)


if __name__ == "__main__":
    tools.main()
