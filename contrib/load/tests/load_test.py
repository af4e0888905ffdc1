"""duet-load against a real server: its counts match the server's, and its files are read back by other
programs."""

import csv
import json
import pathlib
import re
import signal
import subprocess
import tempfile
import unittest

import browser
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

    def open_page(self, name):
        """A page in a browser. Without one, ends the test as skipped: call it last."""
        if not browser.installed():
            self.skipTest(f"all but {name} was checked: {browser.MISSING}")
        chromium = browser.Browser()
        self.addCleanup(chromium.close)
        return chromium.open((self.folder / name).as_uri())

    def handled(self, server):
        """Synthesize calls by status, as the server counts them."""
        text = server.page("/metrics")[1]
        pattern = r'grpc_server_handled_total\{grpc_code="(\w+)",grpc_method="Synthesize".*?\} (\d+)'
        return {code: int(count) for code, count in re.findall(pattern, text)}

    def test_counts_match_the_servers(self):
        server = self.serve()
        report = self.load(server, "--callers", "1,4", "--calls", "24", "--frames", "46=3,92",
                           "--connections", "2", "--records", self.folder / "calls.csv", "--csv",
                           self.folder / "load.csv", "--html", self.folder / "load.html")
        self.assertEqual([step["ended"] for step in report["steps"]], [{"OK": 24}] * 2)
        # Each of the two kinds is tried once before, and cancelled at the first frames.
        tools.wait_until(lambda: sum(self.handled(server).values()) == 50, "the server's count")
        self.assertIn(self.handled(server)["OK"], (48, 49, 50))
        with (self.folder / "calls.csv").open(encoding="utf-8") as file:
            calls = list(csv.DictReader(file))
        self.assertEqual(len(calls), 48)
        for call in calls:
            self.assertEqual(call["frames_received"], call["frames"])
            self.assertLessEqual(float(call["first_chunk_ms"]), float(call["whole_call_ms"]))
        for kind in report["steps"][1]["kinds"]:
            counted = sum(call["load"] == "4 callers" and int(call["frames"]) == kind["frames"]
                          for call in calls)
            self.assertEqual(kind["answers"]["whole_call_ms"]["count"], counted)
        slowest = max(float(call["whole_call_ms"]) for call in calls if call["load"] == "1 caller")
        self.assertAlmostEqual(report["steps"][0]["answers"]["whole_call_ms"]["max"], slowest,
                               delta=0.001)
        self.read_back(report)

    def read_back(self, report):
        with (self.folder / "load.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for row, step in zip(rows, report["steps"], strict=True):
            self.assertEqual(int(row["OK"]), step["ended"]["OK"])
            self.assertAlmostEqual(float(row["whole_call_ms_p99"]),
                                   step["answers"]["whole_call_ms"]["p99"], delta=0.001)
        self.read_page(report)

    def read_page(self, report):
        page = self.open_page("load.html")
        self.assertEqual(page.text("h1"), report["title"])
        titles = page.evaluate("[...document.querySelectorAll('svg')].map((s) => s.ariaLabel)")
        self.assertEqual(titles[:4], ["First chunk by load", "Whole call by load",
                                      "Calls a second by load", "Whole call by percentile"])
        self.assertEqual(page.evaluate("document.querySelectorAll('svg path:not([d])').length"), 0)
        self.assertNotIn("NaN", page.evaluate("document.body.innerHTML"))
        rows = page.evaluate("[...document.querySelectorAll('table')[0].rows].map("
                             "(row) => [...row.cells].map((cell) => cell.textContent))")
        self.assertEqual([row[0] for row in rows], ["load", "1 caller", "4 callers"])
        answered = report["steps"][1]["answered_per_second"]
        self.assertEqual(rows[2][4], f"{answered:.{1 if answered < 100 else 0}f}")
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])

    def test_calls_are_sent_at_the_requested_rate(self):
        # Slow enough for a server under a sanitizer on a busy machine.
        report = self.load(self.serve(), "--rate", "4", "--arrivals", "constant", "--calls", "9")
        step = report["steps"][0]
        self.assertEqual((step["due"], step["sent"], step["ended"]), (9, 9, {"OK": 9}))
        # The last call is due 8/4 s after the first.
        self.assertGreater(step["seconds"], 1.999)

    def test_live_sessions_lose_and_double_no_frame(self):
        server = self.serve()
        report = self.load(server, "--live", "1,3", "--rate", "15", "--seconds", "3", "--leader",
                           tools.sample("hug"), "--leader", tools.sample("kick"), "--jitter", "20",
                           "--loss", "0.05", "--stall", "300", "--delay", "1", "--plan", "5",
                           "--html", self.folder / "live.html")
        self.assertEqual([step["sessions"] for step in report["live"]], [1, 3])
        for step in report["live"]:
            self.assertEqual(step["ended"], {"OK": step["sessions"]})
            self.assertEqual((step["lost"], step["doubled"], step["refused"]), (0, 0, 0))
            self.assertEqual(step["answered"], step["sent"])
            self.assertGreater(step["sent"], 0.7 * 45 * step["sessions"])
            self.assertEqual(step["first_frame_ms"]["count"], step["sessions"])
        # The frames that were lost on the way, over both steps.
        self.assertGreater(sum(step["interpolated"] for step in report["live"]), 0)
        page = self.open_page("live.html")
        self.assertEqual(page.text("h1"), report["title"])
        titles = page.evaluate("[...document.querySelectorAll('svg')].map((s) => s.ariaLabel)")
        self.assertEqual(titles[:2], ["Latency by percentile", "Latency by sessions"])
        self.assertNotIn("NaN", page.evaluate("document.body.innerHTML"))
        self.assertNotIn("undefined", page.evaluate("document.body.innerText"))
        self.assertEqual(page.events("Runtime.exceptionThrown"), [])

    def test_live_sessions_beyond_the_limit_are_refused(self):
        server = self.serve("--max-calls", "2", "--client-share", "1")
        step = self.load(server, "--live", "4", "--rate", "10", "--seconds", "2")["live"][0]
        self.assertEqual(step["ended"], {"OK": 2, "RESOURCE_EXHAUSTED": 2})
        self.assertEqual(step["refused"], 2)

    def test_rejections_are_counted_by_status(self):
        server = self.serve("--max-calls", "2", "--client-share", "1")
        report = self.load(server, "--callers", "8", "--calls", "40", "--frames", "460",
                           "--connections", "8")
        ended = report["steps"][0]["ended"]
        self.assertEqual(sum(ended.values()), 40)
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
            [LOAD, "--server", server.address, "--seconds", "3600", "--warm-up", "0", "--json", "-",
             "--records", self.folder / "calls.csv"], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        # The first block of lines is written after some hundred calls.
        tools.wait_until(lambda: (self.folder / "calls.csv").exists()
                         and (self.folder / "calls.csv").stat().st_size > 1000, "calls")
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=tools.RUN_SECONDS)
        self.assertEqual(process.returncode, 0)
        step = json.loads(out)["steps"][0]
        self.assertEqual(step["ended"], {"OK": step["due"]})


if __name__ == "__main__":
    tools.main()
