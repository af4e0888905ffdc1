"""soak/soak.py for some seconds: no call is lost and every change by the operator works. What
memory does over such a time says nothing."""

import json
import pathlib
import sys
import tempfile
import unittest

import tools

try:
    import grpc  # noqa: F401
except ImportError as error:
    tools.skip(f"{error}; install the package python3-grpcio")
for program in ("openssl", "protoc"):
    if tools.shutil.which(program) is None:
        tools.skip(f"no {program}")

BUILD = pathlib.Path(sys.argv.pop(1))
SOAK = tools.SOURCE / "tests/e2e/soak"
sys.path.insert(0, str(SOAK))
import soak  # pylint: disable=wrong-import-position


class SoakTest(unittest.TestCase):
    def test_no_call_is_lost(self):
        with tempfile.TemporaryDirectory() as folder:
            result = tools.run(sys.executable, "-B", SOAK / "soak.py", BUILD,
                               "--seconds", "4", "--rounds", "2", "--max-growth", "10", "--out",
                               folder, timeout=600)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            figures = json.loads((pathlib.Path(folder) / "soak.json").read_text())
            self.assertEqual((figures["lost"], figures["unfinished"]), (0, 0))
            self.assertGreater(figures["calls"], 50)

    def test_growth_counts_settled_rounds_after_the_warm_up(self):
        rounds = [(size, 0, 0) for size in (50, 90, 100, 100, 100, 100, 100, 103, 104, 105)]
        self.assertAlmostEqual(soak.growth_of(rounds), 0.045)

    def test_each_failure_fails_the_soak(self):
        good = dict(lost=0, unexpected=0, unfinished=0, failed_actions=0, growth=0.01,
                    descriptors_left=0, exit_code=0)
        self.assertTrue(soak.passes(good, 0.02))
        for name in good:
            self.assertFalse(soak.passes({**good, name: 3}, 0.02), name)


if __name__ == "__main__":
    tools.main()
