"""The program behind motion files: its output, its errors, and the message if it is missing."""

import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import support
from duet_motion import files

SCRIPT = f"#!{sys.executable}" + """
import os, signal, sys
if sys.argv[1] == "crash":
    os.kill(os.getpid(), signal.SIGKILL)
print(*sys.argv[1:])
if sys.argv[1] == "fail":
    sys.exit("duet: no!")
"""


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        program = pathlib.Path(folder.name) / "duet"
        program.write_text(SCRIPT, encoding="utf-8")
        program.chmod(0o755)
        self.enterContext(mock.patch.dict(os.environ, {"DUET_PROGRAM": str(program)}))

    def test_output_is_returned(self):
        self.assertEqual(files.run("read", "a b"), "read a b\n")

    def test_failed_command_reports_its_error(self):
        with self.assertRaisesRegex(files.MotionFileError, "^no!$"):
            files.run("fail")
        with self.assertRaisesRegex(files.MotionFileError, "was ended by signal 9"):
            files.run("crash")

    def test_missing_program_explains_how_to_install_it(self):
        with mock.patch.dict(os.environ, {"DUET_PROGRAM": "no-such-duet"}):
            with self.assertRaisesRegex(FileNotFoundError,
                                        "program 'no-such-duet': expected .*Debian package duet.*DUET_PROG"):
                files.run("read")


if __name__ == "__main__":
    unittest.main()
