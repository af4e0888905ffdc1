"""duet-load against a real server: its counts match the server's."""

import json
import pathlib
import re
import signal
import subprocess
import tempfile
import unittest

import tools

LOAD = tools.PROGRAMS / "duet-load"


class LoadTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def serve(self, *flags):
        server = tools.Server(*flags, metrics="127.0.0.1:0")
        self.addCleanup(server.stop)
        return server

    def load(self, server, *flags, code=0):
        result = tools.run(LOAD, "--server", server.address, "--json", self.folder / "load.json",
                           "--warm-up", "0", *flags)
        self.assertEqual(result.returncode, code, result.stderr)
        if (self.folder / "load.json").exists():
            return json.loads((self.folder / "load.json").read_text(encoding="utf-8"))
        return result.stderr

    def handled(self, server):
        """Synthesize calls by status, as the server counts them."""
        text = server.page("/metrics")[1]
        pattern = r'grpc_server_handled_total\{grpc_code="(\w+)",grpc_method="Synthesize".*?\} (\d+)'
        return {code: int(count) for code, count in re.findall(pattern, text)}

    def test_counts_match_the_servers(self):
        server = self.serve()
        report = self.load(server, "--callers", "1,4", "--seconds", "1", "--frames", "92", "--connections", "2")
        calls = 0
        for step in report["steps"]:
            first, whole = (step["answers"][name] for name in ("first_chunk_ms", "whole_call_ms"))
            self.assertEqual(step["ended"], {"OK": step["due"]})
            self.assertEqual((first["count"], whole["count"]), (step["due"], step["due"]))
            self.assertLessEqual(first["p50"], whole["p50"])
            calls += step["due"]
        # One is tried before, and cancelled at the first frames.
        tools.wait_until(lambda: sum(self.handled(server).values()) == calls + 1, "the server's count")
        self.assertIn(self.handled(server)["OK"], (calls, calls + 1))

    def test_calls_are_sent_at_the_requested_rate(self):
        # Slow enough for a server under a sanitizer on a busy machine.
        step = self.load(self.serve(), "--rate", "4", "--seconds", "5")["steps"][0]
        self.assertEqual((step["sent"], step["ended"]), (step["due"], {"OK": step["due"]}))
        self.assertTrue(8 <= step["due"] <= 35, step["due"])  # 20 on average
        self.assertEqual(step["seconds"], 5)

    def test_live_sessions_lose_and_double_no_frame(self):
        server = self.serve()
        report = self.load(server, "--live", "1,3", "--rate", "15", "--seconds", "3")
        self.assertEqual([step["sessions"] for step in report["live"]], [1, 3])
        for step in report["live"]:
            self.assertEqual(step["ended"], {"OK": step["sessions"]})
            self.assertEqual((step["lost"], step["doubled"], step["refused"]), (0, 0, 0))
            self.assertEqual(step["answered"], step["sent"])
            self.assertGreater(step["sent"], 0.7 * 45 * step["sessions"])
            self.assertEqual(step["first_frame_ms"]["count"], step["sessions"])

    def test_live_sessions_beyond_the_limit_are_refused(self):
        server = self.serve("--max-calls", "2", "--client-share", "1")
        step = self.load(server, "--live", "4", "--rate", "10", "--seconds", "2")["live"][0]
        self.assertEqual(step["ended"], {"OK": 2, "RESOURCE_EXHAUSTED": 2})
        self.assertEqual(step["refused"], 2)

    def test_rejections_are_counted_by_status(self):
        server = self.serve("--max-calls", "2", "--client-share", "1")
        report = self.load(server, "--callers", "8", "--seconds", "1", "--frames", "460",
                           "--connections", "8")
        ended = report["steps"][0]["ended"]
        self.assertEqual(sum(ended.values()), report["steps"][0]["due"])
        self.assertGreater(ended["OK"], 0)
        self.assertGreater(ended["RESOURCE_EXHAUSTED"], 0)
        tools.wait_until(lambda: self.handled(server).get("ResourceExhausted")
                         == ended["RESOURCE_EXHAUSTED"], "the server's count")

    def test_invalid_calls_are_reported_before_the_load(self):
        server = self.serve()
        self.assertIn("levitate", self.load(server, "--label", "levitate=1", code=42))
        self.assertIn("nobody", self.load(server, "--model", "nobody", code=42))

    def test_signal_ends_the_run_with_a_report(self):
        server = self.serve()
        process = subprocess.Popen(
            [LOAD, "--server", server.address, "--seconds", "3600", "--warm-up", "0", "--json", "-"],
            stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        tools.wait_until(lambda: self.handled(server).get("OK", 0) > 10, "calls")
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=tools.RUN_SECONDS)
        self.assertEqual(process.returncode, 0)
        step = json.loads(out)["steps"][0]
        self.assertEqual(step["ended"], {"OK": step["due"]})


if __name__ == "__main__":
    tools.main()
