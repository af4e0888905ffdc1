"""Tests run_fuzzers.py: libFuzzer's words, and a run of a made-up fuzzer."""

import pathlib
import tempfile
import unittest

import run_fuzzers

SECONDS = 0.02
OUTPUT = """INFO: Seed: 1
#4\tINITED cov: 2173 ft: 2921 corp: 2/5104b exec/s: 4 rss: 44Mb
#23\tNEW    cov: 2208 ft: 3266 corp: 5/7490b lim: 4486 exec/s: 4 rss: 44Mb L: 761/4486 MS: 1 X-
"""
class ReadOutputTest(unittest.TestCase):
    def test_the_statistics_count(self):
        self.assertEqual(
            run_fuzzers.read_output(OUTPUT + "stat::number_of_executed_units: 37\n"), (37, 2208))


class FuzzerTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = pathlib.Path(folder.name)
        (self.build / "fuzz").mkdir()

    def fuzz(self, script):
        """What comes of a program that stands for a fuzzer."""
        program = self.build / "fuzz" / "fuzz_made_up"
        program.write_text("#!/bin/sh\n" + script, encoding="utf-8")
        program.chmod(0o755)
        return run_fuzzers.Fuzzer(self.build, "made_up").fuzz(SECONDS)

    def test_a_run_that_finds_nothing(self):
        outcome = self.fuzz("trap 'echo stat::number_of_executed_units: 9 >&2; exit 0' USR1\n"
                            "while :; do :; done\n")
        self.assertEqual((outcome.runs, outcome.findings), (9, 0))
        self.assertGreaterEqual(outcome.seconds, SECONDS)

    def test_every_end_but_a_good_one_is_a_finding(self):
        self.assertEqual(self.fuzz("exit 77\n").findings, run_fuzzers.MOST_FINDINGS)

    def test_a_slow_input_counts_where_the_processor_took_long(self):
        slow = self.build / "findings" / "made_up" / "slow-unit-1"
        outcome = self.fuzz(f"echo x >{slow}\necho 'stat::number_of_executed_units: 0' >&2\n")
        self.assertEqual(outcome.findings, 0)
        self.assertFalse(slow.exists())


if __name__ == "__main__":
    unittest.main()
