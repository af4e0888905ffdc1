"""mypy (strict) accepts the package and reports wrong types in its callers."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

import support

CALLER = """\
import duet_motion as duet

leader = duet.Motion([[[0.0, 0.0, 0.0]]], ["root"], 30)
client = duet.Client()
good: duet.SynthesisResult = client.synthesize(leader, {"hug": 1}, seed=3)
client.synthesize(leader, {"hug": "much"})
client.synthesize(leader, sead=3)
"""


@unittest.skipIf(shutil.which("mypy") is None, "no mypy; install the package mypy")
class TypesTest(unittest.TestCase):
    def test_mypy_accepts_the_package_and_reports_a_wrong_caller(self):
        with tempfile.TemporaryDirectory() as folder:
            caller = pathlib.Path(folder) / "caller.py"
            caller.write_text(CALLER, encoding="utf-8")
            found = subprocess.run(
                ["mypy", "--cache-dir", folder, "--no-error-summary", "duet_motion", caller],
                cwd=support.PACKAGE, capture_output=True, text=True, check=False).stdout
        lines = found.splitlines()
        self.assertEqual(len(lines), 2, found)
        self.assertRegex(lines[0], "caller.py:6: error: Dict entry 0 has incompatible type")
        self.assertRegex(lines[1], 'caller.py:7: error: Unexpected keyword argument "sead"')


if __name__ == "__main__":
    unittest.main()
